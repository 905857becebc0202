// The meaning of the properties of a PLY file's vertices.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "load/ply/ply_header.h"
#include "load/ply/ply_rows.h"

namespace candela {

// The numbers of a vertex: x y z nx ny nz u v red green blue alpha.
inline constexpr size_t PLY_X = 0, PLY_NX = 3, PLY_U = 6, PLY_RED = 8, PLY_ALPHA = 11, PLY_NUMBERS = 12;
using PlyVertex = std::array<double, PLY_NUMBERS>;
inline constexpr size_t PLY_SKIPPED = PLY_NUMBERS;

// The properties that are read, and their meaning.
struct PlyVertexFields {
    std::vector<size_t> fields;  // For each property, in the order of the file: its number, or PLY_SKIPPED.
    bool has_normals = false;
    bool has_uvs = false;
    bool has_colors = false;
};

// Finds positions, colours (red green blue, and alpha; or diffuse_red and so on), texture coordinates under
// the first of the names (u v), (s t), (texture_u texture_v), (texture_s texture_t), and normals if they are
// asked for. Incomplete groups and lists are skipped. `warnings` gets colours of an unsupported type; `file`
// is the name in messages.
PlyVertexFields find_vertex_fields(const PlyElement& vertex, bool with_normals, const std::string& file,
                                   std::vector<std::string>& warnings);

// A number of a property of that type as candela uses it: colours linear. Integers represent 0 to 1, and for
// red, green and blue are sRGB, as Blender and MeshLab write them. NaN for normals and texture coordinates
// that are not finite or too large.
double vertex_number(PlyType type, size_t field, double number);

}  // namespace candela
