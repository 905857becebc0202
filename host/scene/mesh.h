// What every mesh goes through between a file and the scene.
#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace candela {

// Removes the triangles whose corners lie on a line or point. Returns how many there were.
size_t drop_flat_triangles(TriangleMesh& mesh);

// Replaces the normals by unit averages of those of the triangles around each position, weighted by the angle
// there. Vertices at equal positions share one normal. It is zero where the triangles cancel each other.
// Ref: Thuermer, Wuethrich, "Computing Vertex Normals from Polygonal Facets" (1998).
void smooth_normals(TriangleMesh& mesh);

// Gives each corner without a normal (a normal of length zero) that of its triangle, in a vertex of its own;
// removes the normals if no vertex has one. No triangle may be flat.
void complete_normals(TriangleMesh& mesh);

}  // namespace candela
