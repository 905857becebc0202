// For light_choice_test.cpp: item (lit point, 32 random bits; normal or 0, light; 32 further bits, whether light from
// both sides is scattered, lamp of the light or NO_LIGHT). The light and lamp that the bits choose, their probability,
// and the probability of the item's light, or 0 if that light is a sun.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 3u
#define RESULT_WORDS 4u
#include "light/choice.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    light_prepare();
    vec3 p = item_floats(0u).xyz, n = item_floats(1u).xyz;
    LitPoint lit = lit_anywhere(p);
    if (n != vec3(0.0)) lit = lit_on_surface(p, n, item(2u).y != 0u);
    light_set_groups(lit);
    LightChoice choice = light_choose(lit, uvec2(item(0u).w, item(2u).x));
    put(choice.i);
    put(choice.lamp);
    put(choice.pmf);
    uint light = item(1u).w;
    bool is_sky = SKY_IS_LIGHT && light == sky_light();
    float pmf = 0.0;
    if (is_sky) pmf = sky_pmf(lit);
    uint lamp = item(2u).z;
    if (light < scene_parameters().lights.placed || is_lamp(lamp)) pmf = light_pmf(light, lamp, lit);
    put(pmf);
}
