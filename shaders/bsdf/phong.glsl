// The modified Phong model: a diffuse base and a lobe around the mirrored direction,
//
//     f = kd / pi + ks (n + 2) / (2 pi) max(0, cos(alpha))^n,   alpha: angle between wi and the mirrored wo,
//
// above the surface, and 0 below. It is reciprocal, and creates no energy if kd + ks <= 1. Local frame, z on the
// viewer's side of the surface.
// Ref: Lafortune and Willems 1994, Using the Modified Phong Reflectance Model for Physically Based Rendering.
//
// At an exponent of 10^5 the lobe is half a degree wide. There cos(alpha) has no digits left, so everything is computed
// from h = 1 - cos(alpha) = |wi - mirrored|^2 / 2 instead.
#ifndef BSDF_PHONG_GLSL
#define BSDF_PHONG_GLSL

#include "base/color.glsl"
#include "base/exponential.glsl"
#include "base/frame.glsl"
#include "base/warp.glsl"
#include "bsdf/mirror.glsl"

// max(0, cos(alpha))^n at wi.
float phong_lobe(float n, vec3 wo, vec3 wi) {
    vec3 chord = wi - mirror_direction(wo);
    float h = 0.5 * dot(chord, chord);
    return h < 1.0 ? exp_nonpositive(n * log1p_nonpositive(-h)) : 0.0;
}

// Probability of sampling the lobe rather than the base: its fraction of the albedo.
float phong_lobe_pmf(vec3 kd, vec3 ks) {
    float base = luminance(kd);
    float lobe = luminance(ks);
    return lobe > 0.0 ? lobe / (base + lobe) : 0.0;
}

// Zero for wi below the surface, where samples fail. n in [0, 10^5].
BsdfValue phong_evaluate(vec3 kd, vec3 ks, float n, vec3 wo, vec3 wi) {
    if (wi.z <= 0.0) return bsdf_zero();
    float lobe = phong_lobe(n, wo, wi);
    float lobe_pdf = 0.5 * INV_PI * (n + 1.0) * lobe;
    return BsdfValue((kd + ks * (0.5 * (n + 2.0) * lobe)) * INV_PI,
                     mix(warp_cosine_hemisphere_pdf(wi.z), lobe_pdf, phong_lobe_pmf(kd, ks)));
}

// wi from the base or from the lobe, as uc in [0,1) chooses, and from u in [0,1)^2. A sample of the lobe that lies
// below the surface fails: the surface absorbs that light.
BsdfSample phong_sample_f(vec3 kd, vec3 ks, float n, vec3 wo, float uc, vec2 u) {
    vec3 wi;
    if (uc < phong_lobe_pmf(kd, ks)) {
        vec3 w = warp_power_cosine(u, n);
        wi = normalize(frame_to_world(frame_from_z(mirror_direction(wo)), w));
    } else {
        wi = warp_cosine_hemisphere(u);
    }
    BsdfValue value = phong_evaluate(kd, ks, n, wo, wi);
    if (value.pdf == 0.0) return bsdf_sample_failed();
    return bsdf_sample(wi, value.f * (wi.z / value.pdf), value.pdf);
}

#endif
