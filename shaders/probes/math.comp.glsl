// For math_test.cpp: is_finite, cos_sin_octant, cos_sin_turn, angle_turn and power_heuristic of an item (x, y, z,
// count), and x + count * y by compensated_add.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 9u
#include "base/warp.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    vec3 v = item_floats(0u).xyz;
    put(uint(is_finite(v)));
    put(cos_sin_octant(v.x));
    put(cos_sin_turn(v.x));
    put(angle_turn(v.y, v.x));
    put(power_heuristic(v.x, v.y));
    vec3 sum = vec3(v.x);
    vec3 compensation = vec3(0.0);
    for (uint i = item(0u).w; i > 0u; --i)
        compensated_add(sum, compensation, vec3(v.y));
    put(sum.x);
    put(compensation.x);
}
