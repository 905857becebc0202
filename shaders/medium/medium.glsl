// Media: what lies between surfaces. A path is in one medium at a time, known by its index.
#ifndef MEDIUM_MEDIUM_GLSL
#define MEDIUM_MEDIUM_GLSL

#include "scene/scene_data.glsl"

// Share of the light that the medium transmits over that distance. An infinite distance is replaced by a finite
// one, since infinity times 0 is NaN. (A compiler that takes all numbers for finite may drop a min with FLOAT_MAX.)
// Ref: Beer and Lambert's law.
vec3 medium_transmittance(uint medium, float distance) {
    const float far = 1e30;
    if (!HAS_MEDIA) return vec3(1.0);
    return exp(-min(distance, far) * scene_medium(medium).absorption);
}

// The medium beyond a surface that is reached through `here` and has `behind` at its back.
uint medium_beyond(uint here, uint behind, bool front) {
    if (behind == MEDIUM_SAME) return here;
    return front ? behind : MEDIUM_NONE;
}

#endif
