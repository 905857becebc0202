// Scattering at a point within a medium: the phase function of Henyey and Greenstein with the mean cosine g, in
// [-0.999, 0.999]. Its integral over all directions is 1; what the medium absorbs is not part of it.
// Local frame: z is wo, so that light that goes straight on has wi = -z.
// Ref: Henyey and Greenstein 1941, Diffuse Radiation in the Galaxy.
#ifndef BSDF_PHASE_GLSL
#define BSDF_PHASE_GLSL

#include "base/warp.glsl"
#include "bsdf/sample.glsl"

// The function [1/sr] where light leaves the favoured direction, forwards or, if g < 0, backwards, by the angle theta
// with h = 1 - cos(theta), in [0, 2].
float phase_value(float g, float h) {
    float a = abs(g);
    float q_squared = square(1.0 - a) + 2.0 * a * h;
    return 0.25 * INV_PI * (1.0 - a) * (1.0 + a) / (q_squared * sqrt(q_squared));
}

// Value and density, which are the same.
BsdfValue phase_evaluate(float g, vec3 wi) {
    vec3 from_favoured = wi - vec3(0.0, 0.0, g < 0.0 ? 1.0 : -1.0);
    float p = phase_value(g, min(0.5 * dot(from_favoured, from_favoured), 2.0));
    return BsdfValue(vec3(p), p);
}

// A direction with that density, from u in [0,1)^2. Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering,
// section 11.3.1, whose cosine is here 1 - h, without loss near the favoured direction, and for all g.
BsdfSample phase_sample_f(float g, vec2 u) {
    float a = abs(g);
    float rest = 1.0 - a + 2.0 * a * u.x;
    float q = (1.0 - a) * (1.0 + a) / rest;
    float h = min((1.0 - a) * (1.0 - u.x) / rest * (q + (1.0 - a)), 2.0);
    vec3 wi = direction_at(h, u.y);
    if (g >= 0.0) wi.z = -wi.z;
    return bsdf_sample(wi, vec3(1.0), phase_value(g, h));
}

#endif
