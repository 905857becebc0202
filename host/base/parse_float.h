// std::from_chars for floating-point numbers, which some standard libraries lack.
#pragma once

#include <charconv>

namespace candela {

// Reads the number at the beginning of [begin, end), as std::from_chars does: without blanks and a plus sign.
// The value stays if there is none, or if it is out of range.
template <class T>
std::from_chars_result parse_float(const char* begin, const char* end, T& value);

// The same by the functions of C, for any standard library, in the locale "C".
template <class T>
std::from_chars_result parse_float_by_c(const char* begin, const char* end, T& value);

}  // namespace candela
