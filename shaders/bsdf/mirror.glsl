// The ideal mirror, tinted. Local frame, z on the viewer's side of the surface.
#ifndef BSDF_MIRROR_GLSL
#define BSDF_MIRROR_GLSL

#include "bsdf/sample.glsl"

// The direction of ideal reflection.
vec3 mirror_direction(vec3 wo) {
    return vec3(-wo.xy, wo.z);
}

BsdfSample mirror_sample_f(vec3 reflectance, vec3 wo) {
    return wo.z > 0.0 ? bsdf_sample_delta(mirror_direction(wo), reflectance, 1.0, 1.0) : bsdf_sample_failed();
}

#endif
