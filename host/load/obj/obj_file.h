// The contents of a Wavefront OBJ file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace candela {

// A name in an OBJ file, and its line, counted from 1.
struct ObjName {
    std::string name;
    uint64_t line = 0;
};

// A corner of a face, its indices counted from 0.
struct ObjCorner {
    static constexpr uint32_t NONE = ~0u;

    uint32_t position = 0;
    uint32_t normal = NONE;
};

struct ObjFile {
    std::vector<glm::dvec3> positions;  // Numbers that floats can hold, or NaN; faces use none of the latter.
    std::vector<vec3> colors;           // Empty, or linear and in [0, 1] for each position.
    std::vector<vec2> uvs;              // Texture coordinates, v upwards, each within +-MAX_UV.
    std::vector<vec3> normals;          // Normals of any length.
    std::vector<ObjCorner> corners;     // Corners of all faces, one after the other.
    std::vector<uint32_t> corner_uvs;   // Empty, or for each corner an index into `uvs`, or ObjCorner::NONE.
    std::vector<uint32_t> sizes;        // Corners of each face, 3 .. MAX_CORNERS.

    // Statements about materials, in the order of the file. `uses` begins with an entry for the faces before
    // any `usemtl`, without a name and with line 0.
    std::vector<ObjName> libraries;
    std::vector<ObjName> uses{{}};
    std::vector<uint32_t> use_of;  // For each face, an index into `uses`.

    // The names after `o`, or after `g` if there is no `o`, of which there are faces, each once; faces before
    // any have one without letters. For each face an index into them. Both are empty if there is no such
    // statement.
    std::vector<std::string> groups;
    std::vector<uint32_t> group_of;

    std::vector<std::string> warnings;  // `file:line: ...` of the first of each kind, or `file: ...`.
};

// Reads the text of a file; `file` is its name in messages. The w of texture coordinates is ignored. With a
// warning,
//   left out are faces with fewer than 3 corners or with vertices that are not finite, lines, points, curves
//   and surfaces;
//   corners have no normal, and texture coordinates (0, 0), where theirs are not in the file or not finite;
//   colours are read as ObjColors::linear() does.
// Throws Error `file:line: cause` for a vertex or normal without three numbers, a colour or texture
// coordinate that is not a number, a face with more than MAX_CORNERS corners, a malformed index, and a
// vertex that is not in the file, and Error `file: cause` if no face is left.
ObjFile parse_obj(std::string_view text, const std::string& file);

}  // namespace candela
