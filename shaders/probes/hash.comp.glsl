// For selftest/samplers.h: every integer function of the samplers.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 10u
#include "base/sampler.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    uvec4 v = item(0u);
    put(hash_pcg3d(v.xyz));
    put(hash_pcg4d(v));
    put(hash_laine_karras(v.x, v.y));
    put(permute_64(v.x & 63u, v.y));
    put(unit_float(v.x));
}
