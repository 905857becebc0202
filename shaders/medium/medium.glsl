// Media: what lies between surfaces. A path is in one medium at a time, known by its index.
#ifndef MEDIUM_MEDIUM_GLSL
#define MEDIUM_MEDIUM_GLSL

#include "scene/scene_data.glsl"

// Share of the light that the medium lets through over that distance [m], which may be infinite: then it is cut to a
// finite one, lest infinity be multiplied by 0. (Compilers that take all numbers for finite may leave a min with
// FLOAT_MAX out.) Ref: Beer and Lambert's law.
vec3 medium_transmittance(uint medium, float distance) {
    const float far = 1e30;
    if (!HAS_MEDIA) return vec3(1.0);
    return exp(-min(distance, far) * scene_medium(medium).absorption);
}

// The medium on the other side of a surface that has `behind` on its back, seen from `here`.
uint medium_beyond(uint here, uint behind, bool front) {
    if (behind == MEDIUM_SAME) return here;
    return front ? behind : MEDIUM_NONE;
}

#endif
