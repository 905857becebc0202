// Replaces bsdf/principled.glsl in kernels without principled materials.
#ifndef BSDF_NO_LAYERS_GLSL
#define BSDF_NO_LAYERS_GLSL

#include "bsdf/sample.glsl"
#include "shared/principled.h"

struct Principled {
    bool unused;
};

BsdfValue principled_evaluate(Principled p, vec3 wo, vec3 wi) {
    return bsdf_zero();
}

BsdfValue principled_coat_evaluate(Principled p, vec3 wo, vec3 wi, float cosine) {
    return bsdf_zero();
}

bool principled_is_sharp(Principled p, float uc) {
    return false;
}

BsdfSample principled_sample_f(Principled p, vec3 wo, float uc, vec2 u) {
    return bsdf_sample_failed();
}

#endif
