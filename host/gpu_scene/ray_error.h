// How far from a surface rays must begin, so that rounding does not make them hit it where they leave it
// [units of the coordinates].
//
// Two errors add up. First, the point of the surface that the shaders compute lies off it, by some roundings
// of the numbers that go into it, projected on the normal. Second, an intersection test takes an origin that
// lies too close to the surface for one on its other side.
#pragma once

#include "base/math.h"

namespace candela {

// Of the point a + (b1 (b - a) + b2 (c - a)): a rounding of its coordinates, one of the ray's origin and one
// to spare, and six of the triangle's extent. Then that of triangles_intersect: its edge functions are off by
// some roundings of the square of the longest side; so are the vertices' weights, by these over twice the
// area; and the distance of the hit, by these times the side. (Of thirteen million rays from all kinds of
// triangles, one hit its own with four roundings, none with eight.) But hits lie in the box around the
// triangle: an origin outside of that, seen along the normal, needs no more, and where an axis is the normal
// nothing is added. For slivers the second error is limited to a thousandth of their length, and some of
// their rays hit them again.
//
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, section 6.8.
double triangle_error(vec3 a, vec3 b, vec3 c);

// Of the point center + radius n with a computed normal n: seven roundings of the radius, and two of the
// centre; sphere_intersect: a squared distance from the centre that differs from the squared radius by eight
// roundings of it.
double sphere_error(vec3 center, float radius);

// Of the point center + x e1 + y e2: some roundings of these numbers; disk_intersect: of the distances from
// the centre along each axis, times the normal and the two roundings of the products of which that is a
// difference.
double disk_error(vec3 center, vec3 e1, vec3 e2);

// Of the point p + x e1 + y e2, x and y in [0, 1], of a flat light: of the sum, which may be greater than the
// result.
double flat_light_error(vec3 p, vec3 e1, vec3 e2);

// The least power of two that is not below `error`, as a float; 0 for 0.
float power_of_two_above(double error);

}  // namespace candela
