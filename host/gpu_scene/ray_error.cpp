// See ray_error.h.
#include "gpu_scene/ray_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace candela {
namespace {

constexpr double ROUNDING = 0x1p-24;  // The largest relative rounding error.

double greatest(dvec3 v) {
    return std::max({v.x, v.y, v.z});
}

}  // namespace

double triangle_error(vec3 a, vec3 b, vec3 c) {
    constexpr double OF_SLIVERS = 0x1p-10;
    const dvec3 p(a), e1(b - a), e2(c - a);
    const dvec3 product = cross(e1, e2);
    const double twice_area = length(product);
    if (twice_area == 0.0) return 0.0;  // No ray hits it.
    const dvec3 n = abs(product / twice_area);
    const dvec3 lo(min(a, min(b, c))), hi(max(a, max(b, c)));
    const double side = greatest(hi - lo);
    const double test = side * std::min(8.0 * ROUNDING * side * side / twice_area, OF_SLIVERS);
    const double point = ROUNDING * dot(n, 3.0 * max(abs(lo), abs(hi)) + 6.0 * (hi - lo));
    return point + std::min(test, dot(n, hi - lo));
}

double sphere_error(vec3 center, float radius) {
    return ROUNDING * (4.0 * length(dvec3(center)) + 16.0 * double(radius));
}

double disk_error(vec3 center, vec3 e1, vec3 e2) {
    const dvec3 a(e1), b(e2);
    const dvec3 product = cross(a, b);
    const double area = length(product);
    if (area == 0.0) return 0.0;  // No ray hits it.
    const dvec3 n = abs(product / area);
    const dvec3 reach = abs(a) + abs(b);
    const dvec3 terms(std::abs(a.y * b.z) + std::abs(a.z * b.y), std::abs(a.z * b.x) + std::abs(a.x * b.z),
                      std::abs(a.x * b.y) + std::abs(a.y * b.x));
    return 8.0 * ROUNDING * (dot(n, abs(dvec3(center)) + reach) + dot(terms, reach) / area);
}

double flat_light_error(vec3 p, vec3 e1, vec3 e2) {
    const dvec3 product = cross(dvec3(e1), dvec3(e2));
    const double area = length(product);
    return area == 0.0 ? 0.0
                       : ROUNDING * dot(abs(product / area),
                                        2.0 * abs(dvec3(p)) + 6.0 * (abs(dvec3(e1)) + abs(dvec3(e2))));
}

float power_of_two_above(double error) {
    if (error == 0.0) return 0.0f;
    int exponent = 0;
    const double mantissa = std::frexp(error, &exponent);
    if (mantissa == 0.5) --exponent;
    return float(std::ldexp(1.0, std::clamp(exponent, std::numeric_limits<float>::min_exponent - 1,
                                            std::numeric_limits<float>::max_exponent - 1)));
}

}  // namespace candela
