// A thin sheet that scatters light to both sides as Lambert's reflector does to one: f = reflectance / pi on the
// viewer's side, transmittance / pi on the other. Local frame, z on the viewer's side of the surface.
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, section 9.2 and class DiffuseTransmissionBxDF.
#ifndef BSDF_DIFFUSE_TRANSMISSION_GLSL
#define BSDF_DIFFUSE_TRANSMISSION_GLSL

#include "base/color.glsl"
#include "base/warp.glsl"
#include "bsdf/sample.glsl"

// Probabilities of sampling the viewer's side and the other one: their shares of the albedo; 0 for a black sheet.
vec2 diffuse_transmission_pmf(vec3 reflectance, vec3 transmittance) {
    vec2 albedo = vec2(luminance(reflectance), luminance(transmittance));
    return albedo.x + albedo.y > 0.0 ? albedo / (albedo.x + albedo.y) : vec2(0.0);
}

// Value and density on both sides; zero for wi within the surface.
BsdfValue diffuse_transmission_evaluate(vec3 reflectance, vec3 transmittance, vec3 wi) {
    vec2 pmf = diffuse_transmission_pmf(reflectance, transmittance);
    float cosine_pdf = warp_cosine_hemisphere_pdf(abs(wi.z));
    if (wi.z > 0.0) return BsdfValue(reflectance * INV_PI, pmf.x * cosine_pdf);
    if (wi.z < 0.0) return BsdfValue(transmittance * INV_PI, pmf.y * cosine_pdf);
    return bsdf_zero();
}

// Cosine-distributed wi from u in [0,1)^2, on the side that uc in [0,1) chooses.
BsdfSample diffuse_transmission_sample_f(vec3 reflectance, vec3 transmittance, float uc, vec2 u) {
    vec2 pmf = diffuse_transmission_pmf(reflectance, transmittance);
    bool reflected = uc < pmf.x;
    float chosen = reflected ? pmf.x : pmf.y;
    if (chosen == 0.0) return bsdf_sample_failed();
    vec3 wi = warp_cosine_hemisphere(u);
    float pdf = chosen * warp_cosine_hemisphere_pdf(wi.z);
    if (!reflected) wi.z = -wi.z;
    return bsdf_sample(wi, (reflected ? reflectance : transmittance) / chosen, pdf);
}

#endif
