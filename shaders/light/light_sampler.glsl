// Chooses a light by its power and a point on it.
#ifndef LIGHT_LIGHT_SAMPLER_GLSL
#define LIGHT_LIGHT_SAMPLER_GLSL

#include "light/area.glsl"
#include "scene/scene_data.glsl"

// A point on one of the lights, seen from p_reference; uc are 32 random bits that choose the light, u in [0,1)^2
// chooses the point. The scene has at least one light.
// Ref: Walker 1977, An Efficient Method for Generating Discrete Random Variables with General Distributions.
LightSample light_sample_li(vec3 p_reference, uint uc, vec2 u) {
    uvec2 column = warp_alias_column(uc, scene_parameters().light_count);
    AliasEntry entry = scene_light_alias(column.x);
    uint chosen = column.y < entry.threshold ? column.x : entry.alias;
    return area_light_sample_li(scene_light(chosen), p_reference, u);
}

#endif
