// Text files that consist of lines of words: what the readers of OBJ, MTL and PLY share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace candela {

// Throws Error if `text`, the contents of `file`, begins with a byte order mark.
void refuse_byte_order_mark(std::string_view text, const std::string& file);

// `text` without the byte order mark at its beginning, if there is one.
std::string_view without_byte_order_mark(std::string_view text);

// Cuts the next word off `line` and returns it; empty at its end. Words are separated by spaces and tabs.
std::string_view next_word(std::string_view& line);

// `text` without the spaces and tabs at its ends.
std::string_view trimmed(std::string_view text);

// The decimal number that is the whole of `word`; none if it is something else. May be infinite or NaN.
std::optional<double> parse_number(std::string_view word);

// The same, if a float can hold it; none for NaN, too.
std::optional<double> parse_finite(std::string_view word);

// Cuts the next line and its end, which is \n, \r\n or \r, off `text`, which is not empty. Returns the line
// without its end.
std::string_view next_line(std::string_view& text);

// Calls visit(line number, first word, rest) for each line, including empty ones.
template <class Visit>
void for_each_line(std::string_view text, Visit visit) {
    for (uint64_t number = 1; !text.empty(); ++number) {
        std::string_view line = next_line(text);
        const std::string_view command = next_word(line);
        visit(number, command, line);
    }
}

}  // namespace candela
