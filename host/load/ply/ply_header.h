// The header of a PLY file, which says what the rest of it holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace candela {

enum class PlyFormat { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
size_t size_of(PlyType type);  // Bytes.
bool is_integer(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> length;  // Type of a list's length, an integer; none: a single number.
};

// A table with a row for, say, each vertex.
struct PlyElement {
    std::string name;
    uint64_t rows = 0;
    std::vector<PlyProperty> properties;  // Properties of each row, in this order.
    uint64_t line = 0;                    // Where the header declares it.

    const PlyProperty* find(std::string_view property) const;  // Null if there is none.
    size_t min_size(PlyFormat format) const;                   // Size of a row whose lists are empty [bytes].
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;   // In the order of the file.
    std::vector<std::string> textures;  // Images that comments name.
    size_t size = 0;                    // Bytes up to the first row.
    uint64_t lines = 0;

    const PlyElement* find(std::string_view element) const;  // Null if there is none.
};

// Reads the header at the front of `bytes`; `file` is the name in messages. The first line says whether lines
// end with a line feed, perhaps after a carriage return, or with a carriage return alone. A byte order mark
// and empty lines are skipped. Throws Error `file:line: cause` for what the format does not allow, and `file:
// cause` if the bytes do not begin with a header, or end within it. Ref: Turk, "The PLY Polygon File Format"
// (1994).
PlyHeader read_ply_header(std::string_view bytes, const std::string& file);

}  // namespace candela
