// Texts made of parts.
#pragma once

#include <array>
#include <charconv>
#include <limits>
#include <sstream>
#include <string>

namespace candela {

// All parts as text, one after the other; numbers with enough digits to tell floats apart.
template <class... Parts>
std::string concat(const Parts&... parts) {
    std::ostringstream text;
    text.precision(std::numeric_limits<float>::max_digits10);
    (text << ... << parts);
    return text.str();
}

// A number in at most `digits` significant digits, for messages.
inline std::string number_text(double number, int digits) {
    std::array<char, 64> text;
    const auto end = std::to_chars(text.begin(), text.end(), number, std::chars_format::general, digits).ptr;
    return {text.data(), end};
}

}  // namespace candela
