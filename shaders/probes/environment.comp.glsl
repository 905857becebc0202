// For selftest/skies.h: the texel in the direction of an item.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 4u
#include "light/environment.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    EnvironmentTexel texel = environment_texel(item_floats(0u).xyz);
    put(texel.radiance);
    put(texel.pdf);
}
