// Pairs the triangles of a mesh that share an edge, so that two become one primitive.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candela {

// One or two triangles of a mesh: a b c, and a c d with the same winding. If there is only one, d is c and
// `second` is `first`.
struct TrianglePair {
    uvec4 corners;    // Indices of the positions a, b, c, d.
    uint32_t first;   // Index of the triangle a b c.
    uint32_t second;  // Index of the triangle a c d.
};

// Every triangle once, in the order of the lesser index in each pair. In that order, each triangle is paired
// with the remaining neighbour that saves the most area: the boxes around each, minus the box around both. It
// stays alone if no pair saves area.
std::vector<TrianglePair> pair_triangles(const TriangleMesh& mesh);

// Each triangle by itself.
std::vector<TrianglePair> single_triangles(const TriangleMesh& mesh);

}  // namespace candela
