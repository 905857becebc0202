// Works on bytes alone, independent of the locale. Ref: The Unicode Standard 15.0, sections 3.9 (UTF-8) and
// 23.
#include "base/printable.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <optional>

namespace candela {
namespace {

constexpr std::string_view ELLIPSIS = "\xE2\x80\xA6";

struct Range {
    uint32_t first, last;
};

// The code points that are escaped. Joiners (U+200C, U+200D) and variation selectors, which words and emoji
// need, are not among them.
constexpr std::array<Range, 21> ESCAPED{{
    {0x0000, 0x001F},    // Controls of ASCII.
    {0x007F, 0x009F},    // DEL and the C1 controls.
    {0x00AD, 0x00AD},    // Soft hyphen.
    {0x034F, 0x034F},    // Combining grapheme joiner.
    {0x061C, 0x061C},    // A mark of direction.
    {0x115F, 0x1160},    // Hangul fillers.
    {0x180E, 0x180E},    // Mongolian vowel separator.
    {0x200B, 0x200B},    // Zero width space.
    {0x200E, 0x200F},    // Marks of direction.
    {0x2028, 0x202E},    // Separators of lines and paragraphs; embeddings and overrides of direction.
    {0x2060, 0x206F},    // Invisible operators; isolates of direction; deprecated controls.
    {0x3164, 0x3164},    // Hangul filler.
    {0xFEFF, 0xFEFF},    // Byte order mark.
    {0xFFA0, 0xFFA0},    // Hangul filler.
    {0xFFF0, 0xFFFB},    // Controls of annotations, and reserved ones.
    {0xFFFE, 0xFFFF},    // No characters; XML cannot hold them.
    {0x13430, 0x1343F},  // Controls of hieroglyphs.
    {0x1BCA0, 0x1BCA3},  // Controls of shorthand.
    {0x1D173, 0x1D17A},  // Controls of music.
    {0xE0000, 0xE00FF},  // Tags.
    {0xE01F0, 0xE0FFF},  // Reserved.
}};

bool is_escaped(uint32_t code) {
    const auto range = std::ranges::lower_bound(ESCAPED, code, {}, &Range::last);
    return range != ESCAPED.end() && code >= range->first;
}

// The first code point of a text that is not empty, or of bytes that are not UTF-8 the first one.
struct Character {
    std::optional<uint32_t> code;
    size_t size = 1;
};

Character first_character(std::string_view text) {
    const auto lead = uint8_t(text[0]);
    if (lead < 0x80) return {lead, 1};
    const size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    constexpr std::array<uint32_t, 5> MIN{0, 0, 0x80, 0x800, 0x10000};
    if (lead < 0xC0 || lead >= 0xF8 || text.size() < size) return {};
    uint32_t code = lead & (0x7Fu >> size);
    for (size_t i = 1; i < size; ++i) {
        if ((uint8_t(text[i]) & 0xC0u) != 0x80u) return {};
        code = code << 6 | (uint8_t(text[i]) & 0x3Fu);
    }
    const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (code < MIN[size] || code > 0x10FFFF || is_surrogate) return {};
    return {code, size};
}

std::string escape_of_byte(char byte) {
    std::array<char, 8> text;
    std::snprintf(text.data(), text.size(), "\\x%02x", unsigned{uint8_t(byte)});
    return text.data();
}

std::string escape_of(uint32_t code) {
    if (code == '\n') return "\\n";
    if (code == '\r') return "\\r";
    if (code == '\t') return "\\t";
    if (code >= 0x10000) return escape_of(0xD7C0 + (code >> 10)) + escape_of(0xDC00 + (code & 0x3FFu));
    std::array<char, 8> text;
    std::snprintf(text.data(), text.size(), "\\u%04x", unsigned{code});
    return text.data();
}

// Cuts the first character off `text`, and returns it as it is shown.
std::string take_character(std::string_view& text) {
    const auto [code, size] = first_character(text);
    const std::string_view bytes = text.substr(0, size);
    text.remove_prefix(size);
    if (!code) return escape_of_byte(bytes[0]);
    return is_escaped(*code) ? escape_of(*code) : std::string(bytes);
}

// As much of the beginning of `text` as fits into `max` bytes; the rest remains in `text`.
std::string take_start(std::string_view& text, size_t max) {
    std::string start;
    while (!text.empty()) {
        std::string_view rest = text;
        const std::string character = take_character(rest);
        if (start.size() + character.size() > max) break;
        start += character;
        text = rest;
    }
    return start;
}

// As much of the end as fits into `max` bytes.
std::string end_of(std::string_view text, size_t max) {
    if (text.size() > max) text.remove_prefix(text.size() - max);
    while (!text.empty() && (uint8_t(text[0]) & 0xC0u) == 0x80u)
        text.remove_prefix(1);  // The rest of a character.
    std::vector<std::string> characters;
    while (!text.empty())
        characters.push_back(take_character(text));
    auto begin = characters.end();
    for (size_t size = 0; begin != characters.begin(); --begin) {
        size += std::prev(begin)->size();
        if (size > max) break;
    }
    std::string end;
    for (; begin != characters.end(); ++begin)
        end += *begin;
    return end;
}

}  // namespace

std::string printable(std::string_view text, size_t max) {
    std::string_view rest = text;
    std::string shown = take_start(rest, max);
    if (rest.empty()) return shown;
    rest = text;
    const size_t room = max - ELLIPSIS.size();
    shown = take_start(rest, room - room / 3);  // The end of a path or a message says more than its middle.
    return shown.append(ELLIPSIS) + end_of(rest, room / 3);
}

std::string printable_json(std::string_view json) {
    std::string shown;
    while (!json.empty()) {
        const size_t length = std::min(json.find('\n'), json.size());
        shown += printable(json.substr(0, length));
        json.remove_prefix(length);
        if (json.empty()) break;
        shown += '\n';
        json.remove_prefix(1);
    }
    return shown;
}

std::string utf8(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const Character character = first_character(text);
        result += character.code ? text.substr(0, character.size) : "\xEF\xBF\xBD";
        text.remove_prefix(character.size);
    }
    return result;
}

std::string joined(std::span<const std::string> names) {
    constexpr size_t MAX_LISTED = 20;
    std::string text;
    for (const std::string& name : names.first(std::min(names.size(), MAX_LISTED)))
        text += (text.empty() ? "" : ", ") + printable(name, MAX_NAME_BYTES);
    if (names.size() > MAX_LISTED) text += " and " + std::to_string(names.size() - MAX_LISTED) + " more";
    return text;
}

}  // namespace candela
