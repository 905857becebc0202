// The BSDF of a material: one case per model. Local frame; see bsdf/sample.glsl for the conventions.
#ifndef BSDF_BSDF_GLSL
#define BSDF_BSDF_GLSL

#include "bsdf/diffuse.glsl"
#include "shared/material.h"

// BSDF value without the cosine [1/sr].
vec3 bsdf_f(MaterialRecord m, vec3 wo, vec3 wi) {
    switch (m.model) {
        case MATERIAL_DIFFUSE: return diffuse_f(m.reflectance, wi);
        default: return vec3(0.0);
    }
}

// A direction wi, its weight and density, from u in [0,1)^2; uc are 32 random bits that choose a lobe.
BsdfSample bsdf_sample_f(MaterialRecord m, vec3 wo, uint uc, vec2 u) {
    switch (m.model) {
        case MATERIAL_DIFFUSE: return diffuse_sample_f(m.reflectance, u);
        default: return BsdfSample(vec3(0.0), vec3(0.0), 0.0);
    }
}

// Density of bsdf_sample_f at wi [1/sr].
float bsdf_pdf(MaterialRecord m, vec3 wo, vec3 wi) {
    switch (m.model) {
        case MATERIAL_DIFFUSE: return diffuse_pdf(wi);
        default: return 0.0;
    }
}

// Share of the light that the surface sends back, per channel, for the albedo image and for choosing lobes.
vec3 bsdf_albedo(MaterialRecord m) {
    switch (m.model) {
        case MATERIAL_DIFFUSE: return m.reflectance;
        default: return vec3(0.0);
    }
}

#endif
