// Texts: made of parts, in lower case.
#pragma once

#include <array>
#include <charconv>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>

namespace candela {

// All parts as text, one after the other; numbers with enough digits to tell floats apart.
template <class... Parts>
std::string concat(const Parts&... parts) {
    std::ostringstream text;
    text.precision(std::numeric_limits<float>::max_digits10);
    (text << ... << parts);
    return text.str();
}

// The text with the letters A to Z in lower case, in every locale.
inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    }
    return lower;
}

// A number in at most `digits` significant digits, for messages.
inline std::string number_text(double number, int digits) {
    std::array<char, 64> text;
    const auto end = std::to_chars(text.begin(), text.end(), number, std::chars_format::general, digits).ptr;
    return {text.data(), end};
}

}  // namespace candela
