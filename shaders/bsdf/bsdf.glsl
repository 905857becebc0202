// The BSDF of a material: one line per model. Local frame; see bsdf/sample.glsl for the conventions.
//
// Before it includes this, a kernel defines LAYERED: 1 if it has the code of principled materials, else 0. (It is not a
// specialization constant, since drivers read all of the code before they apply those.)
#ifndef BSDF_BSDF_GLSL
#define BSDF_BSDF_GLSL

#include "bsdf/conductor.glsl"
#include "bsdf/dielectric.glsl"
#include "bsdf/diffuse.glsl"
#include "bsdf/diffuse_transmission.glsl"
#include "bsdf/mirror.glsl"
#include "bsdf/phase.glsl"
#include "bsdf/phong.glsl"
#if LAYERED
#include "bsdf/principled.glsl"
#else
#include "bsdf/no_layers.glsl"
#endif
#include "shared/kernel_constants.h"
#include "shared/material.h"

const uint MATERIALS_DIELECTRIC = 1u << MATERIAL_DIELECTRIC_SCHLICK | 1u << MATERIAL_DIELECTRIC_EXACT;

// True if light samples on all sides are needed: some surface scatters light that comes from behind it, or media do.
const bool LIT_FROM_BEHIND = (MATERIALS & (1u << MATERIAL_DIFFUSE_TRANSMISSION | 1u << MATERIAL_PHASE) |
                              PRINCIPLED & PRINCIPLED_IS_LIT_FROM_BEHIND) != 0u;

// A material at one point of a surface, seen from one side.
struct Bsdf {
    uint model;  // MATERIAL_*
    vec3 base;   // As in MaterialRecord, as is `specular`.
    vec3 specular;
    float parameter;  // As in MaterialRecord, except eta: the index on the other side over that on the viewer's.
    Principled principled;
};

// True if the model is one of `models` (bits). Models that the scene does not have leave no code in the kernel, and a
// scene of one model needs no branch.
bool is_model(Bsdf b, const uint models) {
    if ((MATERIALS & models) == 0u) return false;
    if ((MATERIALS & ~models) == 0u) return true;
    return (1u << b.model & models) != 0u;
}

// True if light that passes the surface is refracted.
bool bsdf_refracts(MaterialRecord m) {
    Bsdf b;
    b.model = m.model;
    if (is_model(b, 1u << MATERIAL_PRINCIPLED)) return m.medium != MEDIUM_SAME;
    return is_model(b, MATERIALS_DIELECTRIC);
}

// True if some light passes the surface.
bool material_transmits(MaterialRecord m) {
    Bsdf b;
    b.model = m.model;
    if (is_model(b, 1u << MATERIAL_PRINCIPLED)) return m.specular.y != 0.0;
    return is_model(b, MATERIALS_DIELECTRIC | 1u << MATERIAL_DIFFUSE_TRANSMISSION);
}

// The material seen from its front, or from its back, where the two media of a dielectric are swapped.
// The lobes of a principled material are added later: see integrator/layers.glsl.
Bsdf bsdf_at(MaterialRecord m, bool front) {
    Bsdf b;
    b.model = m.model;
    b.base = m.base;
    b.specular = m.specular;
    b.parameter = m.parameter;
    if (bsdf_refracts(m) && !front) b.parameter = 1.0 / b.parameter;
    return b;
}

// Value and density; zero where scattering is ideal.
BsdfValue bsdf_evaluate(Bsdf b, vec3 wo, vec3 wi) {
    if (is_model(b, 1u << MATERIAL_DIFFUSE)) return diffuse_evaluate(b.base, wi);
    if (is_model(b, 1u << MATERIAL_PHONG)) return phong_evaluate(b.base, b.specular, b.parameter, wo, wi);
    if (is_model(b, 1u << MATERIAL_CONDUCTOR)) return conductor_evaluate(b.base, b.parameter, wo, wi);
    if (is_model(b, 1u << MATERIAL_DIFFUSE_TRANSMISSION)) return diffuse_transmission_evaluate(b.base, b.specular, wi);
    if (is_model(b, 1u << MATERIAL_PHASE)) return phase_evaluate(b.parameter, wi);
    if (is_model(b, 1u << MATERIAL_PRINCIPLED)) return principled_evaluate(b.principled, wo, wi);
    return bsdf_zero();
}

// The value times the cosine and the density of a coat with its own normal, for wi below the horizon of the layers
// under it; 0 for other wi.
BsdfValue bsdf_evaluate_coat(Bsdf b, vec3 wo, vec3 wi) {
    bool has_coat = (PRINCIPLED & PRINCIPLED_HAS_COAT_NORMAL) != 0u && is_model(b, 1u << MATERIAL_PRINCIPLED);
    if (!has_coat) return bsdf_zero();
    return principled_coat_evaluate(b.principled, wo, wi, 1.0);
}

// A direction wi, its weight and density, from u in [0,1)^2; uc in [0,1) chooses a lobe.
BsdfSample bsdf_sample_f(Bsdf b, vec3 wo, float uc, vec2 u) {
    if (is_model(b, 1u << MATERIAL_DIFFUSE)) return diffuse_sample_f(b.base, u);
    if (is_model(b, 1u << MATERIAL_PHONG)) return phong_sample_f(b.base, b.specular, b.parameter, wo, uc, u);
    if (is_model(b, 1u << MATERIAL_MIRROR)) return mirror_sample_f(b.base, wo);
    if (is_model(b, 1u << MATERIAL_CONDUCTOR)) return conductor_sample_f(b.base, b.parameter, wo, u);
    if (is_model(b, MATERIALS_DIELECTRIC)) {
        return dielectric_sample_f(b.parameter, b.model == MATERIAL_DIELECTRIC_EXACT, wo, uc);
    }
    if (is_model(b, 1u << MATERIAL_DIFFUSE_TRANSMISSION)) {
        return diffuse_transmission_sample_f(b.base, b.specular, uc, u);
    }
    if (is_model(b, 1u << MATERIAL_PHASE)) return phase_sample_f(b.parameter, u);
    if (is_model(b, 1u << MATERIAL_PRINCIPLED)) return principled_sample_f(b.principled, wo, uc, u);
    return bsdf_sample_failed();
}

// Whether the lobe that uc in [0, 1) chooses is as sharp as a mirror or clear glass, nearly, and such lobes scatter
// most of the light.
bool bsdf_is_sharp(Bsdf b, float uc) {
    if (is_model(b, MATERIALS_DIELECTRIC | 1u << MATERIAL_MIRROR)) return true;
    if (is_model(b, 1u << MATERIAL_CONDUCTOR)) return b.parameter <= SHARP_ALPHA;
    if (is_model(b, 1u << MATERIAL_PRINCIPLED)) return principled_is_sharp(b.principled, uc);
    return false;
}

// Fraction of the light that the surface scatters at normal incidence, per channel, for the albedo image.
vec3 bsdf_albedo(Bsdf b) {
    if (is_model(b, MATERIALS_DIELECTRIC)) return vec3(1.0);
    return is_model(b, 1u << MATERIAL_PHONG | 1u << MATERIAL_DIFFUSE_TRANSMISSION) ? b.base + b.specular : b.base;
}

#endif
