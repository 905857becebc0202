// The contents of a Wavefront OBJ file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace candela {

// A name that an OBJ file mentions, and the line where it does, counted from 1.
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
    std::vector<glm::dvec3> positions;  // Numbers that floats can hold.
    std::vector<vec3> colors;           // Empty, or linear and in [0, 1] for each position.
    std::vector<vec2> uvs;              // Texture coordinates, v upwards, each within +-MAX_UV.
    std::vector<vec3> normals;          // Of any length.
    std::vector<ObjCorner> corners;     // Of all faces, one after the other.
    std::vector<uint32_t> corner_uvs;   // Empty, or for each corner an index into `uvs`, or ObjCorner::NONE.
    std::vector<uint32_t> sizes;        // Corners of each face, 3 .. MOST_CORNERS.

    // Statements about materials, in the order of the file. `uses` begins with that of the faces before any
    // `usemtl`, which has no name and line 0.
    std::vector<ObjName> libraries;
    std::vector<ObjName> uses{{}};
    std::vector<uint32_t> use_of;  // For each face, an index into `uses`.
};

// Reads the text of a file; `file` is its name in messages. Three numbers after a position are its colour,
// white where only others have one; the w of texture coordinates and groups are ignored. Throws Error
// `file:line: cause` for a vertex or normal without three finite numbers, a colour out of range, a texture
// coordinate that is not finite or greater than MAX_UV, a face with fewer than 3 or more than MOST_CORNERS
// corners, a malformed index or one that is out of range, and Error `file: cause` if there is no face at all.
ObjFile parse_obj(std::string_view text, const std::string& file);

}  // namespace candela
