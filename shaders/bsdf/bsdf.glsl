// The BSDF of a material: one line per model. Local frame; see bsdf/sample.glsl for the conventions.
#ifndef BSDF_BSDF_GLSL
#define BSDF_BSDF_GLSL

#include "bsdf/conductor.glsl"
#include "bsdf/dielectric.glsl"
#include "bsdf/diffuse.glsl"
#include "bsdf/mirror.glsl"
#include "bsdf/phong.glsl"
#include "shared/kernel_constants.h"
#include "shared/material.h"

const uint MATERIALS_DIELECTRIC = 1u << MATERIAL_DIELECTRIC_SCHLICK | 1u << MATERIAL_DIELECTRIC_EXACT;

// True if the material is of one of those models (bits). Models that the scene does not have leave no code in the
// kernel, and a scene of one model needs no branch.
bool is_model(MaterialRecord m, const uint models) {
    if ((MATERIALS & models) == 0u) return false;
    if ((MATERIALS & ~models) == 0u) return true;
    return (1u << m.model & models) != 0u;
}

// The material as seen from the front side, or from the back, where the media of a dielectric change places.
MaterialRecord bsdf_from_side(MaterialRecord m, bool front) {
    if (is_model(m, MATERIALS_DIELECTRIC) && !front) m.parameter = 1.0 / m.parameter;
    return m;
}

// BSDF value without the cosine [1/sr]; 0 where scattering is ideal.
vec3 bsdf_f(MaterialRecord m, vec3 wo, vec3 wi) {
    if (is_model(m, 1u << MATERIAL_DIFFUSE)) return diffuse_f(m.base, wi);
    if (is_model(m, 1u << MATERIAL_PHONG)) return phong_f(m.base, m.specular, m.parameter, wo, wi);
    if (is_model(m, 1u << MATERIAL_CONDUCTOR)) return conductor_f(m.base, m.parameter, wo, wi);
    return vec3(0.0);
}

// A direction wi, its weight and density, from u in [0,1)^2; uc in [0,1) chooses a lobe.
BsdfSample bsdf_sample_f(MaterialRecord m, vec3 wo, float uc, vec2 u) {
    if (is_model(m, 1u << MATERIAL_DIFFUSE)) return diffuse_sample_f(m.base, u);
    if (is_model(m, 1u << MATERIAL_PHONG)) return phong_sample_f(m.base, m.specular, m.parameter, wo, uc, u);
    if (is_model(m, 1u << MATERIAL_MIRROR)) return mirror_sample_f(m.base, wo);
    if (is_model(m, 1u << MATERIAL_CONDUCTOR)) return conductor_sample_f(m.base, m.parameter, wo, u);
    if (is_model(m, MATERIALS_DIELECTRIC)) {
        return dielectric_sample_f(m.parameter, m.model == MATERIAL_DIELECTRIC_EXACT, wo, uc);
    }
    return bsdf_sample_failed();
}

// Density of bsdf_sample_f at wi [1/sr]; 0 where scattering is ideal.
float bsdf_pdf(MaterialRecord m, vec3 wo, vec3 wi) {
    if (is_model(m, 1u << MATERIAL_DIFFUSE)) return diffuse_pdf(wi);
    if (is_model(m, 1u << MATERIAL_PHONG)) return phong_pdf(m.base, m.specular, m.parameter, wo, wi);
    if (is_model(m, 1u << MATERIAL_CONDUCTOR)) return conductor_pdf(m.parameter, wo, wi);
    return 0.0;
}

// Share of the light that the surface sends on at normal incidence, per channel, for the albedo image.
vec3 bsdf_albedo(MaterialRecord m) {
    if (is_model(m, MATERIALS_DIELECTRIC)) return vec3(1.0);
    return is_model(m, 1u << MATERIAL_PHONG) ? m.base + m.specular : m.base;
}

#endif
