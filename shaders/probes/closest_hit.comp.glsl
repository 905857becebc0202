// For bench/tracer.h: item (ray with t_max). The id of the nearest primitive, or NO_TRIANGLE: one word, so that most of
// the time is traversal.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 1u
#include "probes/items.glsl"
#include "scene/traversal.glsl"

void main() {
    if (past_end()) return;
    Hit hit = bvh_intersect(Ray(item_floats(0u).xyz, item_floats(1u).xyz));
    put(is_hit(hit) ? hit_id(hit) : 0xFFFFFFFFu);
}
