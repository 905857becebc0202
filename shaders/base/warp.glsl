// Warps of the unit square: every sampling routine beside its density.
#ifndef BASE_WARP_GLSL
#define BASE_WARP_GLSL

#include "base/exponential.glsl"
#include "base/math.glsl"
#include "shared/light.h"

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

// The unit direction with 1 - cos(theta) = h, in [0, 2], around +z, at an azimuth of that many turns. Near the pole, h
// keeps the digits that the cosine loses.
vec3 direction_at(float h, float turn) {
    return vec3(sqrt(max(0.0, h * (2.0 - h))) * cos_sin_turn(turn), 1.0 - h);
}

// Direction on the hemisphere around +z with the density (n + 1) / (2 pi) cos(theta)^n [1/sr], from u in [0,1)^2, for n
// in [0, 10^5]. cos(theta) = (1 - u)^(1 / (n + 1)).
vec3 warp_power_cosine(vec2 u, float n) {
    return direction_at(-expm1_nonpositive(log1p_nonpositive(-u.x) / (n + 1.0)), u.y);
}

// Uniform direction on the unit sphere; density 1 / (4 pi) [1/sr].
vec3 warp_sphere(vec2 u) {
    return direction_at(2.0 * u.x, u.y);
}

// Direction around +z, uniform over the cone in which 1 - cos(theta) <= h_max.
vec3 warp_cone(vec2 u, float h_max) {
    return direction_at(u.x * h_max, u.y);
}

// Its density within that cone [1/sr].
float warp_cone_pdf(float h_max) {
    return 0.5 * INV_PI / h_max;
}

// Normal of a GGX microfacet that w sees, with the density G1(w) max(0, w.h) D(h) / w.z [1/sr], from u in [0,1)^2; w.z
// > 0, alpha along x and y in (0, 1]. Ref: Heitz 2018, Sampling the GGX Distribution of Visible Normals, section 3.
vec3 warp_ggx_visible_normal(vec2 u, vec2 alpha, vec3 w) {
    // In stretched space the facets form a hemisphere. Its visible part projects to a disk, minus a piece behind the
    // horizon.
    vec3 v = normalize(vec3(alpha * w.xy, w.z));
    float across = dot(v.xy, v.xy);
    vec3 t1 = across > 1e-30 ? vec3(-v.y, v.x, 0.0) * inversesqrt(across) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(v, t1);
    vec2 d = warp_disk(u);
    d.y = mix(sqrt(max(0.0, 1.0 - d.x * d.x)), d.y, 0.5 * (1.0 + v.z));
    vec3 h = d.x * t1 + d.y * t2 + sqrt(max(0.0, 1.0 - dot(d, d))) * v;
    return normalize(vec3(alpha * h.xy, max(1e-7, h.z)));
}

vec3 warp_ggx_visible_normal(vec2 u, float alpha, vec3 w) {
    return warp_ggx_visible_normal(u, vec2(alpha), w);
}

// Uniform barycentric coordinates (b1, b2) on a triangle from u in [0,1)^2; density 1/area [1/m^2]. Continuous,
// without a square root. Ref: Heitz 2019, A Low-Distortion Map Between Triangle and Square.
vec2 warp_triangle(vec2 u) {
    return u.x < u.y ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

// Uniform point on the regular polygon with that many corners (>= 3) on the unit circle, the first of them at (1, 0),
// from u in [0,1)^2. Its area is blades / 2 sin(2 pi / blades).
vec2 warp_polygon(vec2 u, uint blades) {
    float scaled = u.x * float(blades);
    float blade = min(floor(scaled), float(blades - 1u));
    vec2 b = warp_triangle(vec2(scaled - blade, u.y));
    return b.x * cos_sin_turn(blade / float(blades)) + b.y * cos_sin_turn((blade + 1.0) / float(blades));
}

// Index of a column of an alias table of n entries and the 32 bits that decide within it, from 32 random bits.
// All 32 bits are used: the high word of n * bits is the column, the low word its fraction.
uvec2 warp_alias_column(uint bits, uint n) {
    uint column, fraction;
    umulExtended(bits, n, column, fraction);
    return uvec2(column, fraction);
}

// The choice of an alias table.
struct AliasChoice {
    uint i;
    float rest;  // Uniform in [0, 1): the unused randomness.
};

// The choice of a column (index and the 32 bits that decide within it), whose entry is given.
AliasChoice warp_alias_choice(uvec2 column, AliasEntry entry) {
    bool keep = column.y < entry.threshold;
    float rest = keep ? float(column.y) / float(entry.threshold)
                      : float(column.y - entry.threshold) / max(1.0, 4294967296.0 - float(entry.threshold));
    return AliasChoice(keep ? column.x : entry.alias, min(rest, 1.0 - 1.0 / 16777216.0));
}

// Weight of a sample drawn with density pdf if another strategy has density pdf_other (same measure), one sample each;
// power heuristic with exponent 2. 0 if pdf is 0, 1 if it is too large to compare with pdf_other.
// Ref: Veach 1997, Robust Monte Carlo Methods for Light Transport Simulation, section 9.2.4.
float power_heuristic(float pdf, float pdf_other) {
    if (pdf == 0.0) return 0.0;
    return 1.0 / (1.0 + square(pdf_other / pdf));
}

#endif
