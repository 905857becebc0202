// For light_choice_test.cpp: item (lit point, 32 random bits; normal or 0, light). The light that the bits choose, its
// probability, and the probability of the item's light.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 3u
#include "light/choice.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    light_prepare();
    vec3 p = item_floats(0u).xyz, n = item_floats(1u).xyz;
    LitPoint lit = lit_anywhere(p);
    if (n != vec3(0.0)) lit = lit_on_surface(p, n, false);
    uint chosen = light_choose(lit, item(0u).w);
    put(chosen);
    put(light_pmf(chosen, lit));
    put(light_pmf(item(1u).w, lit));
}
