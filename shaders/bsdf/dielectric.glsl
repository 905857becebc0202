// A smooth boundary between two transparent media: it reflects or refracts, never both at once. Local frame, z on the
// viewer's side; eta is the index of refraction on the other side over that on the viewer's.
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, section 9.5.
#ifndef BSDF_DIELECTRIC_GLSL
#define BSDF_DIELECTRIC_GLSL

#include "bsdf/fresnel.glsl"
#include "bsdf/mirror.glsl"
#include "shared/kernel_constants.h"

// The reflected ray with the probability of Fresnel's term, otherwise the refracted one; uc in [0,1) chooses. The
// projected solid angle of a beam grows by eta^2 on its way through to the viewer, so its radiance is divided by eta^2.
// A ray passes a boundary between equal indices as if it were not there (where Schlick's approximation would reflect at
// its rim).
BsdfSample dielectric_sample_f(float eta, bool exact, vec3 wo, float uc) {
    if (eta == 1.0) return bsdf_sample_delta(-wo, vec3(1.0), 1.0, 1.0);
    if (wo.z <= 0.0) return bsdf_sample_failed();
    float cos_t = refracted_cosine(dot(wo.xy, wo.xy), eta);
    float reflected = exact ? fresnel_dielectric_exact(wo.z, cos_t, eta) : fresnel_dielectric_schlick(wo.z, cos_t, eta);
    if (uc < reflected) return bsdf_sample_delta(mirror_direction(wo), vec3(1.0), reflected, 1.0);
    vec3 wi = normalize(vec3(-wo.xy / eta, -cos_t));
    return bsdf_sample_delta(wi, vec3(1.0 / square(eta)), 1.0 - reflected, eta);
}

#endif
