// Texts made of parts.
#pragma once

#include <limits>
#include <sstream>
#include <string>

namespace candela {

// All parts one after another as text; numbers with as many digits as tell floats apart.
template <class... Parts>
std::string concat(const Parts&... parts) {
    std::ostringstream text;
    text.precision(std::numeric_limits<float>::max_digits10);
    (text << ... << parts);
    return text.str();
}

}  // namespace candela
