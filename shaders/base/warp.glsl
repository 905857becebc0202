// Warps of the unit square: every sampling routine beside its density.
#ifndef BASE_WARP_GLSL
#define BASE_WARP_GLSL

#include "base/math.glsl"

// Uniform point on the unit disk from u in [0,1)^2, area-preserving and continuous; density 1/pi [1/m^2].
// Ref: Shirley and Chiu 1997, A Low Distortion Map Between Disk and Square.
vec2 warp_disk(vec2 u) {
    vec2 s = 2.0 * u - 1.0;
    bool wide = abs(s.x) > abs(s.y);
    float r = wide ? s.x : s.y;
    if (r == 0.0) return vec2(0.0);
    vec2 direction = cos_sin_octant((PI / 4.0) * (wide ? s.y / s.x : s.x / s.y));
    return r * (wide ? direction : direction.yx);
}

// Direction on the hemisphere around +z with density warp_cosine_hemisphere_pdf, from u in [0,1)^2; unit length.
// The point on the disk is the projection of the direction (Malley's method).
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, section A.5.3.
vec3 warp_cosine_hemisphere(vec2 u) {
    vec2 d = warp_disk(u);
    return vec3(d, sqrt(max(0.0, 1.0 - dot(d, d))));
}

// Density of warp_cosine_hemisphere [1/sr] at a direction with that cosine to +z, >= 0.
float warp_cosine_hemisphere_pdf(float cos_theta) {
    return cos_theta * INV_PI;
}

// Uniform barycentric coordinates (b1, b2) on a triangle from u in [0,1)^2; density 1/area [1/m^2]. Continuous,
// without a square root. Ref: Heitz 2019, A Low-Distortion Map Between Triangle and Square.
vec2 warp_triangle(vec2 u) {
    return u.x < u.y ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

// Index of a column of an alias table of n entries and the 32 bits that decide within it, from 32 random bits.
// All 32 bits are used: the high word of n * bits is the column, the low word its fraction.
uvec2 warp_alias_column(uint bits, uint n) {
    uint column, fraction;
    umulExtended(bits, n, column, fraction);
    return uvec2(column, fraction);
}

// Weight of a sample drawn with density pdf where another strategy has density pdf_other (same measure), one
// sample each; power heuristic with exponent 2. 0 where pdf is 0; an infinite pdf wins.
// Ref: Veach 1997, Robust Monte Carlo Methods for Light Transport Simulation, section 9.2.4.
float power_heuristic(float pdf, float pdf_other) {
    if (pdf == 0.0) return 0.0;
    return 1.0 / (1.0 + square(pdf_other / pdf));
}

#endif
