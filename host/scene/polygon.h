// Polygons cut into triangles.
#pragma once

#include <span>
#include <vector>

#include "base/math.h"

namespace candela {

// The most corners that a polygon of a file may have, since cutting it may take cubic time.
inline constexpr size_t MAX_CORNERS = 1024;

// Cuts a polygon of n >= 3 corners, convex or concave, nearly planar, into n - 2 triangles of the same
// winding, given as indices into `corners`. A polygon that crosses itself is cut arbitrarily. Time grows with
// the square of n, in the worst case with its cube.
// Ref: Meisters, "Polygons Have Ears" (1975).
std::vector<uvec3> triangulate(std::span<const vec3> corners);

}  // namespace candela
