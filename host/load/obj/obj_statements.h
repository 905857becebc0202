// The statements of an OBJ file, and their words.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "load/text_lines.h"

namespace candela {

// What the corner of a face refers to, in the order of `1/2/3`.
struct ObjKind {
    std::string_view command;
    const char* name;
};
inline constexpr std::array<ObjKind, 3> OBJ_KINDS{
    {{"v", "vertex"}, {"vt", "texture coordinate"}, {"vn", "normal"}}};
inline constexpr size_t OBJ_POSITION = 0;
inline constexpr size_t OBJ_UV = 1;
inline constexpr size_t OBJ_NORMAL = 2;

// Whether a statement ends before this word.
inline bool is_obj_end(std::string_view word) {
    return word.empty() || word.starts_with('#');
}

inline bool is_obj_face(std::string_view command) {
    return command == "f" || command == "fo";
}

inline std::optional<size_t> obj_kind_of(std::string_view command) {
    for (size_t i = 0; i < OBJ_KINDS.size(); ++i) {
        if (OBJ_KINDS[i].command == command) return i;
    }
    return std::nullopt;
}

// The number that a word spells, infinite or NaN if no float can hold it; nothing if it is not a number.
// Older programs for Windows write NaN as -1.#IND and the like.
inline std::optional<double> obj_number(std::string_view word) {
    if (word.find(".#") != std::string_view::npos) return std::numeric_limits<double>::quiet_NaN();
    const std::optional<double> number = parse_number(word);
    if (number && !parse_finite(word)) return std::numeric_limits<double>::quiet_NaN();
    return number;
}

// for_each_line(), but a backslash at the end of a line joins it with the next one. It does not where it may
// end a name or a comment.
template <class Visit>
void for_each_obj_statement(std::string_view text, Visit visit) {
    std::string joined;
    for (uint64_t number = 1; !text.empty();) {
        const uint64_t first = number++;
        std::string_view line = next_line(text);
        std::string_view rest = line;
        const std::string_view command = next_word(rest);
        if ((is_obj_face(command) || obj_kind_of(command)) && trimmed(line).ends_with('\\')) {
            joined = trimmed(line);
            while (joined.ends_with('\\')) {
                joined.back() = ' ';
                if (text.empty()) break;
                joined += trimmed(next_line(text));
                ++number;
            }
            line = joined;
        }
        const std::string_view first_word = next_word(line);
        visit(first, first_word, line);
    }
}

}  // namespace candela
