// For bench/tracer.h: item (ray with t_max). ANY_HIT if the ray hits anything before t_max, else NO_TRIANGLE: one word,
// so that most of the time is traversal.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 1u
#include "probes/items.glsl"
#include "scene/traversal.glsl"

void main() {
    if (past_end()) return;
    Ray ray = Ray(item_floats(0u).xyz, item_floats(1u).xyz);
    put(bvh_occluded(ray, item_floats(0u).w) ? 0u : 0xFFFFFFFFu);
}
