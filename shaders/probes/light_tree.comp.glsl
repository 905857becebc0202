// For light_tree_test.cpp: item (lit point, light; normal or 0, whether light from both sides is scattered). The
// probabilities of the way to that light, by importance and by strength, and whether it ends there.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 3u
#include "light/tree.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    vec3 p = item_floats(0u).xyz, n = item_floats(1u).xyz;
    LitPoint lit = lit_anywhere(p);
    if (n != vec3(0.0)) lit = lit_on_surface(p, n, item(1u).w != 0u);
    uint light = item(0u).w;
    LightTreeWay way = light_tree_begin(0u);
    light_tree_follow(way, lit, scene_light_trail(light));
    put(way.by_importance);
    put(way.by_strength);
    put(uint(way.at == (light | LIGHT_TREE_LEAF_BIT)));
}
