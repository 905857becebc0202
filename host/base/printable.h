// Texts from files, drivers and libraries, made safe for a terminal: they do not move the cursor, colour or
// hide text, change its direction or begin a line, and they are not too long.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace candela {

// The most bytes that are shown of a name or another text within a message, of the name of a file, and of a
// whole message.
inline constexpr size_t MAX_NAME_BYTES = 120;
inline constexpr size_t MAX_PATH_BYTES = 1000;
inline constexpr size_t MAX_MESSAGE_BYTES = 4000;

// `text` with its control and invisible characters escaped as in JSON (`\u001b`, `\n`), and bytes that are
// not UTF-8 as `\xff`. A text longer than `max` bytes (at least 40) loses its middle: `…` replaces whole
// characters. A second call changes nothing.
std::string printable(std::string_view text, size_t max = SIZE_MAX);

// The same JSON, in UTF-8, with the characters that printable() escapes escaped in its strings.
std::string printable_json(std::string_view json);

// The text with U+FFFD for each byte that is not UTF-8.
std::string utf8(std::string_view text);

// "a, b, c": printable names; after 20, how many more there are.
std::string joined(std::span<const std::string> names);

// The warnings in as few lines as possible, each a printable message. A warning that differs from an earlier
// one only in its place (`file:line:column: ...` or `file#/pointer: ...`) is counted with it. If more than
// three differ only in names and numbers, the first three are followed by the number of the others. Beyond 64
// KiB in all, warnings are only counted. The kinds are in the order of their first warnings.
std::vector<std::string> summary_of(const std::vector<std::string>& warnings);

}  // namespace candela
