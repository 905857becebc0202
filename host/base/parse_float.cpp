// See parse_float.h.
#include "base/parse_float.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <version>

namespace candela {
namespace {

float of_text(const char* text, char** stop, float) {
    return std::strtof(text, stop);
}

double of_text(const char* text, char** stop, double) {
    return std::strtod(text, stop);
}

}  // namespace

template <class T>
std::from_chars_result parse_float_by_c(const char* begin, const char* end, T& value) {
    const std::from_chars_result none{begin, std::errc::invalid_argument};
    const std::string text(begin, end);
    // What only strtod reads: blanks and a plus sign before a number, hexadecimal digits after 0x.
    const size_t first = text.starts_with('-') ? 1 : 0;
    if (first == text.size() || text[first] == '-' || text[first] == '+' ||
        std::isspace(uint8_t(text[first])))
        return none;
    if (text[first] == '0' && first + 1 < text.size() && (text[first + 1] == 'x' || text[first + 1] == 'X')) {
        value = first == 0 ? T(0) : -T(0);
        return {begin + first + 1, std::errc()};
    }
    char* stop = nullptr;
    const T number = of_text(text.c_str(), &stop, T());
    const auto length = size_t(stop - text.c_str());
    if (length == 0) return none;
    const char* const after = begin + length;
    const size_t of_digits = std::min(text.find_first_of("eE"), length);
    const bool too_small = number == T(0) && text.find_first_of("123456789") < of_digits;
    const bool too_large = std::isinf(number) && std::toupper(uint8_t(text[first])) != 'I';
    if (too_small || too_large) return {after, std::errc::result_out_of_range};
    value = number;
    return {after, std::errc()};
}

template <class T>
std::from_chars_result parse_float(const char* begin, const char* end, T& value) {
#ifdef __cpp_lib_to_chars
    return std::from_chars(begin, end, value);
#else
    return parse_float_by_c(begin, end, value);
#endif
}

template std::from_chars_result parse_float(const char*, const char*, float&);
template std::from_chars_result parse_float(const char*, const char*, double&);
template std::from_chars_result parse_float_by_c(const char*, const char*, float&);
template std::from_chars_result parse_float_by_c(const char*, const char*, double&);

}  // namespace candela
