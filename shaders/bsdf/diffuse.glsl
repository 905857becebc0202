// Lambert's reflector: f = reflectance / pi. Local frame, z on the viewer's side of the surface.
#ifndef BSDF_DIFFUSE_GLSL
#define BSDF_DIFFUSE_GLSL

#include "base/warp.glsl"
#include "bsdf/sample.glsl"

// Zero for wi below the surface.
BsdfValue diffuse_evaluate(vec3 reflectance, vec3 wi) {
    if (wi.z <= 0.0) return bsdf_zero();
    return BsdfValue(reflectance * INV_PI, warp_cosine_hemisphere_pdf(wi.z));
}

// Cosine-distributed wi from u in [0,1)^2: weight f cos / pdf is exactly the reflectance.
BsdfSample diffuse_sample_f(vec3 reflectance, vec2 u) {
    vec3 wi = warp_cosine_hemisphere(u);
    return bsdf_sample(wi, reflectance, warp_cosine_hemisphere_pdf(wi.z));
}

#endif
