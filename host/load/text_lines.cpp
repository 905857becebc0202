// Words and numbers, independent of the locale.
#include "load/text_lines.h"

#include <cmath>
#include <limits>
#include <system_error>

#include "base/error.h"
#include "base/parse_float.h"

namespace candela {
namespace {

constexpr const char* BLANKS = " \t";
constexpr std::string_view BYTE_ORDER_MARK = "\xEF\xBB\xBF";

}  // namespace

void refuse_byte_order_mark(std::string_view text, const std::string& file) {
    if (!text.starts_with(BYTE_ORDER_MARK)) return;
    throw Error(file + ":1: the file begins with a byte order mark; save it without one");
}

std::string_view without_byte_order_mark(std::string_view text) {
    return text.starts_with(BYTE_ORDER_MARK) ? text.substr(BYTE_ORDER_MARK.size()) : text;
}

std::string_view next_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(BLANKS), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(BLANKS));
    line.remove_prefix(word.size());
    return word;
}

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(BLANKS), text.size()));
    return text.substr(0, text.find_last_not_of(BLANKS) + 1);
}

std::optional<double> parse_number(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const char* end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, error] = parse_float(word.data(), end, value);
    if (error != std::errc() || stop != end) return std::nullopt;
    return value;
}

std::optional<double> parse_finite(std::string_view word) {
    const std::optional<double> value = parse_number(word);
    const bool fits = value && std::abs(*value) <= double(std::numeric_limits<float>::max());
    return fits ? value : std::nullopt;  // Comparisons with NaN are false.
}

std::string_view next_line(std::string_view& text) {
    const size_t length = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, length);
    text.remove_prefix(length);
    text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<size_t>(1, text.size()));
    return line;
}

}  // namespace candela
