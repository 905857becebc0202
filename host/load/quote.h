// Quotes the words of a file in messages.
#pragma once

#include <string>
#include <string_view>

#include "base/printable.h"

namespace candela {

// `text` in quotation marks, as messages show it: printable, and cut at MOST_NAME_BYTES.
std::string quote(std::string_view text);

// `text` as a whole string of JSON. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

}  // namespace candela
