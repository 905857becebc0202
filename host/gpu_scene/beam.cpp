// See beam.h.
#include "gpu_scene/beam.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <variant>

namespace candela {
double one_minus_cos(double angle) {
    const double s = std::sin(0.5 * angle);
    return 2.0 * s * s;
}

dvec3 unit_direction(dvec3 direction) {
    // Divided by its greatest component first, which keeps squares from over- and underflowing.
    const dvec3 size = abs(direction);
    return normalize(direction / std::max({size.x, size.y, size.z}));
}

vec3 cone_parameters(const Cone& cone) {
    // Beyond that, the edge is harder than floats can tell.
    constexpr double STEEPEST = 1e30;
    const double inner = one_minus_cos(double(cone.inner_angle));
    const double outer = one_minus_cos(double(cone.outer_angle));
    return {float(outer), float(std::min(1.0 / (outer - inner), STEEPEST)),
            cone.falloff == SpotFalloff::smoothstep ? 1.0f : 0.0f};
}

double mean_in_cone(const Cone& cone) {
    const double inner = one_minus_cos(double(cone.inner_angle));
    const double outer = one_minus_cos(double(cone.outer_angle));
    // The means between the angles of t^2 and t^2 (3 - 2t), where t is uniform.
    const double between = cone.falloff == SpotFalloff::smoothstep ? 1.0 / 2.0 : 1.0 / 3.0;
    return 0.5 * (inner + (outer - inner) * between);
}

double fraction_within(float spread) {
    const double angle = std::atan2(1.0, double(spread));  // At which there is no light.
    constexpr double SMALL = 0.01;                         // Below it, the series has more digits.
    if (angle < SMALL) return angle * angle * (1.0 / 3.0 + angle * angle / 45.0);
    return 1.0 - angle * double(spread);
}

double set_beam(LightRecord& light, const Shape& shape) {
    if (shape.beam.spread < PI) {
        const double tangent = std::tan(0.5 * double(shape.beam.spread));
        light.spread = std::bit_cast<float>(floatBitsToUint(float(1.0 / tangent)) & ~LIGHT_KINDS);
    }
    double fraction = fraction_within(light.spread);
    if (light.kind == LIGHT_BEAM) {
        const vec3 axis(unit_direction(std::get<Sphere>(shape.geometry).axis));
        const vec3 cone = cone_parameters(*shape.beam.cone);
        light.e1 = vec3(light.e1.x, axis.x, axis.y);
        light.e2 = vec3(cone.x, cone.z > 0.0f ? -cone.y : cone.y, axis.z);
        fraction *= mean_in_cone(*shape.beam.cone);
    }
    return fraction;
}

}  // namespace candela
