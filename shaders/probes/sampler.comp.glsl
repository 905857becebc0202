// For selftest/samplers.h: the three random words of a sample (pixel, n, seed) for a pair of dimensions.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 3u
#include "base/sampler.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    uvec4 v = item(0u);
    put(sampler_triple(sampler_make(uvec2(v.x & 0xFFFFu, v.x >> 16u), v.y, v.z), v.w));
}
