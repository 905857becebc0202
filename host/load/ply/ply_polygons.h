// The contents of a PLY file's rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"

namespace candela {

struct PlyPolygons {
    // Attributes of vertices; all except the positions may be empty.
    std::vector<glm::dvec3> positions;
    std::vector<vec3> normals;
    std::vector<vec2> uvs;
    std::vector<vec4> colors;

    std::vector<uint32_t> corners;  // Corners of all polygons, one after the other.
    std::vector<uint32_t> sizes;    // Corners of each polygon.
};

// Leaves out the vertices that no polygon uses. In the others, normals that are not finite become 0 (no
// normal), and texture coordinates that are not finite become 0; `warnings` gets their numbers. Throws Error,
// which begins with the name `file`, for a position that is not finite, and for a colour beyond 0 to 1.
void finish_vertices(PlyPolygons& polygons, const std::string& file, std::vector<std::string>& warnings);

}  // namespace candela
