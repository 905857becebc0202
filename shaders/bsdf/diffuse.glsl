// Lambert's reflector: f = reflectance / pi. Local frame, z on the viewer's side of the surface.
#ifndef BSDF_DIFFUSE_GLSL
#define BSDF_DIFFUSE_GLSL

#include "base/warp.glsl"
#include "bsdf/sample.glsl"

// BSDF value, without the cosine [1/sr]; 0 for wi below the surface.
vec3 diffuse_f(vec3 reflectance, vec3 wi) {
    return wi.z > 0.0 ? reflectance * INV_PI : vec3(0.0);
}

// Density of diffuse_sample_f at wi [1/sr].
float diffuse_pdf(vec3 wi) {
    return warp_cosine_hemisphere_pdf(max(0.0, wi.z));
}

// Cosine-distributed wi from u in [0,1)^2: weight f cos / pdf is exactly the reflectance.
BsdfSample diffuse_sample_f(vec3 reflectance, vec2 u) {
    vec3 wi = warp_cosine_hemisphere(u);
    return bsdf_sample(wi, reflectance, warp_cosine_hemisphere_pdf(wi.z));
}

#endif
