// Every exception as an Error, so that the program ends, or a batch goes on, in the same way after each.
#pragma once

#include "base/error.h"

namespace candela {

// The exception that is being handled.
Error caught_error();

}  // namespace candela
