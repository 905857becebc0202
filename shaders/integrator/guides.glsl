// What guides a denoiser: albedo and normal of the first surface on a path that does not scatter like a mirror or clear
// glass, and what tints it on the way. So a picture in a mirror keeps its edges and textures.
#ifndef INTEGRATOR_GUIDES_GLSL
#define INTEGRATOR_GUIDES_GLSL

#include "integrator/surface.glsl"
#include "shared/kernel_constants.h"

const bool HAS_GUIDES = DENOISING_LAYER != 0u;

struct Guides {
    vec3 albedo;  // In [0, 1], tinted; 0 if the path leaves the scene, and there is no sky.
    vec3 normal;  // World space, towards the ray; 0 for the sky.
    vec3 tint;    // Product of the weights of sharp scattering so far, without that of Russian roulette, in [0, 1].
    bool found;   // The path has met a surface that is not sharp.
};

Guides guides_begin() {
    return Guides(vec3(0.0), vec3(0.0), vec3(1.0), false);
}

// Notes what the path meets next. Emitted radiance counts as albedo, as far as a screen can show it.
// Ref: Áfra, Intel Open Image Denoise, its documentation of the filter RT, on auxiliary feature images.
void guides_meet(inout Guides guides, vec3 albedo, vec3 emitted, vec3 normal) {
    guides.albedo = guides.tint * clamp(albedo + emitted, 0.0, 1.0);
    guides.normal = normal;
}

// Notes how the path scatters at x, by the lobe that uc chose.
void guides_scatter(inout Guides guides, ShadedSurface x, float uc, BsdfSample scattered) {
    guides.found = !bsdf_is_sharp(x.bsdf, uc);
    guides.tint *= clamp(scattered.weight * square(scattered.eta), 0.0, 1.0);
}

#endif
