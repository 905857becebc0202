// The directions in which lights emit, as their records have them.
#pragma once

#include "base/math.h"
#include "scene/scene.h"
#include "shared/light.h"

namespace candela {

// 1 - cos, without cancellation.
double one_minus_cos(double angle);

// The unit vector in a direction of any length above 0.
dvec3 unit_direction(dvec3 direction);

// 1 - cos of the outer angle, one over the range of cosines in which it falls off, and 0 if by the square, 1
// if by smoothstep.
vec3 cone_parameters(const Cone& cone);

// The mean over all directions of the cone's factor.
double mean_in_cone(const Cone& cone);

// The power of a light of that spread, divided by that of one without.
double fraction_within(float spread);

// Gives the record of a light with a surface the directions in which its shape emits. Returns the power of
// the light, divided by that of one without a beam.
double set_beam(LightRecord& light, const Shape& shape);

}  // namespace candela
