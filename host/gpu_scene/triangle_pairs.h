// Pairs the triangles of a mesh that share an edge, so that two become one primitive.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candela {

// Triangles of a mesh, one or two of them: a b c, and a c d with the same winding. Where there is but one, d
// is c and `second` is `first`.
struct TrianglePair {
    uvec4 corners;    // Indices of the positions a, b, c, d.
    uint32_t first;   // Index of the triangle a b c,
    uint32_t second;  // and of a c d.
};

// Every triangle once, in the order of the lesser index in each pair. In that order each triangle takes, of
// those that are left, the neighbour with which it fits into the smallest box; none if that box is met by
// more rays than the two around each, which would cost more than it saves.
std::vector<TrianglePair> pair_triangles(const TriangleMesh& mesh);

// Each triangle by itself.
std::vector<TrianglePair> single_triangles(const TriangleMesh& mesh);

}  // namespace candela
