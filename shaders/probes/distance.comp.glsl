// For selftest/media.h: a path that enters a medium.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 6u
#define RESULT_WORDS 5u
#include "medium/distance.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    MediumRecord medium = medium_unpack(item(0u), item(1u));
    vec4 path = item_floats(2u);
    vec4 focus = item_floats(4u);
    vec2 lit = item_floats(5u).xy;
    MediumSample s = medium_sample(medium, path.xyz, path.w, Focus(focus.x, focus.y, focus.z, lit), item(3u));
    put(uint(s.scattered));
    put(s.t);
    put(s.weight);
}
