// The parts that need not be inlined: messages, and text.
#include "load/ply/ply_rows.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "load/quote.h"
#include "load/text_lines.h"

namespace candela {
namespace {

bool fits(double number, PlyType type) {
    if (!is_integer(type)) return true;
    const bool is_signed = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
    const double values = std::ldexp(1.0, int(8 * size_of(type)));
    const double min = is_signed ? -0.5 * values : 0.0;
    return std::trunc(number) == number && number >= min && number < min + values;
}

}  // namespace

void PlyPosition::fail(const std::string& cause) const {
    const std::string place = line == 0 ? file : file + ':' + std::to_string(line);
    throw Error(place + ": " + element + ' ' + std::to_string(row) + ' ' + cause);
}

void PlyPosition::fail_at_end() const {
    fail("is missing or incomplete; is the file cut off?");
}

void PlyAsciiRows::begin_row() {
    skip_empty_lines();
    if (text_.empty()) position_.fail_at_end();
    row_ = next_line(text_);
    ++position_.line;
}

double PlyAsciiRows::next(PlyType type) {
    const std::string_view word = next_word(row_);
    if (word.empty()) position_.fail("has too few numbers; is the file cut off?");
    const auto number = parse_number(word);
    if (number && fits(*number, type)) return *number;
    // How older programs for Windows write infinity and NaN: 1.#INF, -1.#IND, 1.#QNAN.
    if (!is_integer(type) && word.find(".#") != std::string_view::npos)
        return std::numeric_limits<double>::quiet_NaN();
    const size_t size = size_of(type);
    position_.fail("has " + shown(quote(word)) + " in place of " +
                   (is_integer(type) ? "an integer of " : "a number of ") + std::to_string(size) +
                   (size == 1 ? " byte" : " bytes"));
}

void PlyAsciiRows::end_row() {
    if (!next_word(row_).empty()) position_.fail("has more numbers than the header announces");
}

size_t PlyAsciiRows::trailing_bytes() {
    skip_empty_lines();
    return text_.size();
}

void PlyAsciiRows::skip_empty_lines() {
    while (!text_.empty()) {
        std::string_view after = text_;
        if (!trimmed(next_line(after)).empty()) return;
        text_ = after;
        ++position_.line;
    }
}

}  // namespace candela
