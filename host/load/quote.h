// Quotes the words of a file in messages.
#pragma once

#include <string>
#include <string_view>

namespace candela {

// `text` (UTF-8) in quotation marks, with control characters escaped.
std::string quote(std::string_view text);

}  // namespace candela
