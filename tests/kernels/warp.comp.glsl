// For warp_test.cpp: the warps of a point u of the unit square.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 8u
#include "base/warp.glsl"
#include "items.glsl"

void main() {
    if (past_end()) return;
    vec2 u = item_floats(0u).xy;
    vec3 direction = warp_cosine_hemisphere(u);
    put(warp_disk(u));
    put(direction);
    put(warp_cosine_hemisphere_pdf(direction.z));
    put(warp_triangle(u));
}
