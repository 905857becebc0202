// Filters of pixels: where a sample of a pixel lies, with the density of the filter, so that all samples weigh the same
// and each belongs to one pixel alone.
// Ref: Ernst, Stamminger and Greiner 2006, Filter Importance Sampling.
#ifndef BASE_PIXEL_FILTER_GLSL
#define BASE_PIXEL_FILTER_GLSL

#include "base/exponential.glsl"
#include "base/math.glsl"
#include "shared/kernel_constants.h"

// Each of the following maps u in [0,1)^2 to a point relative to the pixel's centre, in halves of the filter's width.

// Density (1 - |x|) (1 - |y|) on [-1,1]^2.
vec2 filter_tent(vec2 u) {
    vec2 s = 2.0 * u - 1.0;
    return sign(s) * (1.0 - sqrt(1.0 - abs(s)));
}

// Density proportional to exp(-9/2 (x^2 + y^2)) on the unit disk, which ends at three standard deviations.
vec2 filter_gaussian(vec2 u) {
    const float deviations = 3.0;
    const float within = 0.98889100346;  // 1 - exp(-9/2)
    float r = sqrt(-2.0 * log1p_nonpositive(-within * u.x)) / deviations;
    return min(r, 1.0) * cos_sin_turn(u.y);
}

// Density of Blackman and Harris along one axis, 1 + sum of b_k cos(pi k x) on [-1,1], by Newton's method: along the
// rising half of the window its integral is convex, so that each step but the first comes closer from above. Four steps
// after the fourth root leave less than 1e-6.
float filter_blackman_harris(float u) {
    const vec3 b = vec3(0.48829, 0.14128, 0.01168) / 0.35875;
    float tail = min(u, 1.0 - u);
    float x = 0.5 * sqrt(sqrt(2.0 * tail));  // From the nearer end of the window, in its widths.
    for (uint i = 0u; i < 4u; ++i) {
        vec2 w = cos_sin_turn(x);
        float cos_2 = 2.0 * w.x * w.x - 1.0;
        vec3 cosines = vec3(w.x, cos_2, w.x * (2.0 * cos_2 - 1.0));
        vec3 sines = w.y * vec3(1.0, 2.0 * w.x, 2.0 * cos_2 + 1.0);
        vec3 signs = vec3(-1.0, 1.0, -1.0);
        float integral = x + dot(signs * b / vec3(1.0, 2.0, 3.0), sines) * (0.5 * INV_PI);
        x = clamp(x - (integral - tail) / (1.0 + dot(signs * b, cosines)), 0.0, 0.5);
    }
    return (u < 0.5 ? 2.0 : -2.0) * (x - 0.5);
}

vec2 filter_blackman_harris(vec2 u) {
    return vec2(filter_blackman_harris(u.x), filter_blackman_harris(u.y));
}

// A film position of a sample of that pixel, from u in [0,1)^2.
vec2 filter_film_position(uvec2 pixel, vec2 u) {
    if (PIXEL_FILTER == PIXEL_FILTER_SQUARE) return vec2(pixel) + u;
    vec2 place = 2.0 * u - 1.0;
    if (PIXEL_FILTER == PIXEL_FILTER_TENT) place = filter_tent(u);
    if (PIXEL_FILTER == PIXEL_FILTER_GAUSSIAN) place = filter_gaussian(u);
    if (PIXEL_FILTER == PIXEL_FILTER_BLACKMAN_HARRIS) place = filter_blackman_harris(u);
    return vec2(pixel) + (0.5 + 0.5 * uintBitsToFloat(PIXEL_FILTER_WIDTH) * place);
}

#endif
