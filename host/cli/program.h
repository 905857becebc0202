// The command line as a whole: from the words of the call to the command that they name.
#pragma once

#include "base/error.h"

namespace candela {

// Parses the command line and runs the command; help and version go to stdout. Returns the exit code of a run
// that did its work. Throws Error, with exit code usage and what is wrong if the command line is.
ExitCode run_program(int argc, const char* const* argv);

}  // namespace candela
