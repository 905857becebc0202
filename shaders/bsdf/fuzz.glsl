// Fuzz: a layer of short fibres among which light scatters many times, to the directions of Lambert's law under a
// linear transform that depends on wo alone. Local frame, z on the viewer's side of the surface.
// Ref: Zeltner, Burley and Chiang 2022, Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines; the
// fits are those of MaterialX 1.39 (mx_microfacet_sheen.glsl), for OpenPBR 1.1.
#ifndef BSDF_FUZZ_GLSL
#define BSDF_FUZZ_GLSL

#include "base/exponential.glsl"
#include "base/math.glsl"
#include "base/warp.glsl"

// The fits are not made for smaller values, where fuzz reflects at most a ten-thousandth.
const float MIN_FUZZ_ROUGHNESS = 0.01;

// Fraction of light from wo, given by its cosine, that white fuzz reflects: 0 to 0.75. Roughness as above, up to 1.
float fuzz_albedo(float roughness, float cos_o) {
    const float INV_SQRT_2_PI = 0.398942280;
    float y = roughness;
    float width = y * (0.0206607 + y * 1.58491) / (0.0379424 + y * (1.32227 + y));
    float mean = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    float offset = y * (0.000654023 + y * (-0.0207818 + y * 0.119681)) / (1.26264 + y * (-1.92021 + y));
    float gaussian = exp_nonpositive(-0.5 * square((cos_o - mean) / width)) * INV_SQRT_2_PI / width;
    return max(gaussian + offset, 0.0);
}

// (a, k): the inverse transform maps wi to (a wi.xy + k wi.z wo.xy, wi.z). So it does not need a frame whose x is the
// azimuth of wo, which is undefined at normal incidence.
vec2 fuzz_shape(float roughness, float cos_o) {
    float x = cos_o, y = roughness;
    float a = (2.58126 * x + 0.813703 * y) * y / (1.0 + x * (0.310327 * x + 2.60994 * y));
    float k = (y - 1.0) * y * y * y / (0.0000254053 + x * (1.71228 - 1.71506 * y) + 1.34174 * y * y);
    return vec2(a, k * inversesqrt(1.0 + x));
}

// The value over the albedo [1/sr]; both directions above the surface. Times the cosine of wi, it is the density of
// fuzz_direction().
float fuzz_f(vec2 shape, vec3 wo, vec3 wi) {
    vec3 w = vec3(shape.x * wi.xy + shape.y * wi.z * wo.xy, wi.z);
    return INV_PI * square(shape.x / dot(w, w));
}

// A direction wi from u in [0, 1)^2.
vec3 fuzz_direction(vec2 shape, vec3 wo, vec2 u) {
    vec3 w = warp_cosine_hemisphere(u);
    return normalize(vec3((w.xy - shape.y * w.z * wo.xy) / shape.x, w.z));
}

#endif
