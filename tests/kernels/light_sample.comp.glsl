// For light_test.cpp: item (reference point, 32 bits for the light; u). A light sample from there.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 13u
#include "items.glsl"
#include "light/light_sampler.glsl"

void main() {
    if (past_end()) return;
    LightSample s = light_sample_li(item_floats(0u).xyz, item(0u).w, item_floats(1u).xy);
    put(s.p);
    put(s.n);
    put(s.wi);
    put(s.Li);
    put(s.pdf);
}
