// Chooses a light by its power and a point on it; one line per kind of light.
#ifndef LIGHT_LIGHT_SAMPLER_GLSL
#define LIGHT_LIGHT_SAMPLER_GLSL

#include "base/sampler.glsl"
#include "light/area.glsl"
#include "light/environment.glsl"
#include "light/sphere.glsl"

// The light of a scene that has no other, which an invocation reads once.
Light only_light;

// Before an invocation's first light sample.
void light_prepare() {
    if (ONE_LIGHT) only_light = scene_light(0u);
}

// The light at that place in the table of lights.
Light light_at(uint i) {
    if (ONE_LIGHT) return only_light;
    return scene_light(i);
}

// A point on one of the lights, seen from p_reference, from 2 x 32 random bits. The first word chooses the light as
// well, if there are several, and what the choice leaves of it is uniform again: so the points of a light are as well
// spread as those of a sampler are. The 8 low bits of `fill` are random too, and become those of the word. The scene
// has at least one light; light_prepare comes first.
// Ref: Walker 1977, An Efficient Method for Generating Discrete Random Variables with General Distributions.
LightSample light_sample_li(vec3 p_reference, uvec2 u, uint fill) {
    uint i = 0u;
    if (!ONE_LIGHT) {
        uvec2 column = warp_alias_column(u.x, scene_parameters().light_count);
        AliasChoice choice = warp_alias_choice(column, scene_light_alias(column.x));
        i = choice.i;
        u.x = uint(choice.rest * 16777216.0) << 8u | (fill & 255u);
    }
    Light l = light_at(i);
    if (is_light(l, LIGHT_ENVIRONMENT)) return environment_light_sample_li(u);
    if (is_light(l, LIGHT_SPHERE)) return sphere_light_sample_li(l, p_reference, unit_float(u));
    return area_light_sample_li(l, p_reference, unit_float(u));
}

// Density [1/sr] with which light_sample_li finds the point of light l at that squared distance [m^2] from p_reference,
// seen under that cosine of its normal; not for the environment.
float light_pdf_li(Light l, vec3 p_reference, float distance_squared, float cos_light) {
    if (is_light(l, LIGHT_SPHERE)) return sphere_light_pdf_li(l, p_reference, distance_squared, cos_light);
    return area_light_pdf_li(l, distance_squared, cos_light);
}

#endif
