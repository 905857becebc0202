// For selftest/exponentials.h: logarithm and exponentials of an item x <= 0.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 3u
#include "base/exponential.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    float x = item_floats(0u).x;
    put(log1p_nonpositive(x));
    put(exp_nonpositive(x));
    put(expm1_nonpositive(x));
}
