// How far from a surface rays must begin, so that rounding does not make them hit it where they leave it
// [units of the coordinates].
//
// Two errors add up. First, the point that the shaders compute lies off the surface, by some roundings of its
// inputs, projected on the normal. Second, an intersection test treats an origin too close to the surface as
// one on its other side.
#pragma once

#include "base/math.h"

namespace candela {

// For the point a + (b1 (b - a) + b2 (c - a)): a rounding of its coordinates, one of the ray's origin and one
// to spare, and six of the triangle's extent. Then the error of triangles_intersect: its edge functions are
// off by some roundings of the square of the longest side; the vertices' weights are off by these over twice
// the area, and the distance of the hit by these times the side. (Of thirteen million rays from all kinds of
// triangles, one hit its own with four roundings, none with eight.) But hits lie in the box around the
// triangle: an origin outside the box, seen along the normal, needs no more, and nothing is added if the
// normal is an axis. For slivers the second error is limited to a thousandth of their length, and some of
// their rays hit them again.
//
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, section 6.8.
double triangle_error(vec3 a, vec3 b, vec3 c);

// For the point center + radius n with a computed normal n: seven roundings of the radius, and two of the
// centre; sphere_intersect: a squared distance from the centre that differs from the squared radius by eight
// roundings of it.
double sphere_error(vec3 center, float radius);

// For the point center + x e1 + y e2: some roundings of these numbers; disk_intersect: some of the distances
// from the centre along each axis, times the normal and the two roundings of the products whose difference it
// is.
double disk_error(vec3 center, vec3 e1, vec3 e2);

// For the point p + x e1 + y e2, x and y in [0, 1], of a flat light: roundings of the sum, which may be
// greater than the result.
double flat_light_error(vec3 p, vec3 e1, vec3 e2);

// The least power of two that is not below `error`, as a float; 0 for 0.
float power_of_two_above(double error);

}  // namespace candela
