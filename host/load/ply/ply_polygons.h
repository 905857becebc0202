// What the rows of a PLY file hold.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"

namespace candela {

struct PlyPolygons {
    // Of vertices; all but the positions may be empty.
    std::vector<glm::dvec3> positions;
    std::vector<vec3> normals;
    std::vector<vec2> uvs;
    std::vector<vec4> colors;

    std::vector<uint32_t> corners;  // Of all polygons, one after the other.
    std::vector<uint32_t> sizes;    // Corners of each polygon.
};

// Leaves out the vertices that no polygon uses. Of the others, normals that are not finite become 0, which
// stands for none, and texture coordinates that are not finite become 0; `warnings` gets how many there were.
// Throws Error, which begins with the name `file`, for a position that is not finite, and for a colour beyond
// 0 to 1.
void finish_vertices(PlyPolygons& polygons, const std::string& file, std::vector<std::string>& warnings);

}  // namespace candela
