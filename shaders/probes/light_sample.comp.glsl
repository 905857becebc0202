// For selftest/lights.h: item (reference point, 32 random bits for the light; 2 x 32 for the point). A light sample
// from there; whether its shadow ray is blocked; and, for a ray in its direction, the light that it hits, its radiance,
// and the density with which light samples find it.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 18u
#include "light/light_sampler.glsl"
#include "probes/items.glsl"
#include "scene/interaction.glsl"

void main() {
    if (past_end()) return;
    vec3 from = item_floats(0u).xyz;
    light_prepare();
    LitPoint lit = lit_anywhere(from);
    light_set_groups(lit);
    LightSample s = light_sample_li(lit, uvec3(item(1u).xy, item(0u).w));
    put(s.wi);
    put(s.Li);
    put(s.pdf);
    put(uint(s.delta));
    put(s.shadow);
    put(s.t_max);
    put(uint(bvh_occluded(Ray(from, s.shadow), s.t_max)));

    Ray ray = Ray(from, s.wi);
    Hit hit = bvh_intersect(ray);
    uint light = NO_LIGHT;
    float pdf = 0.0;
    vec3 L = vec3(0.0);
    if (!is_hit(hit)) {
        EnvironmentTexel texel = environment_texel(s.wi);
        pdf = environment_pdf_li(texel, lit);
        L = texel.radiance;
    } else {
        Interaction met = interaction_at(ray, hit);
        light = met.light;
        if (light != NO_LIGHT) {
            pdf = light_pdf_li(light, met.lamp, lit, square(hit.t), dot(met.wo, met.n), met.front);
            L = area_light_le(scene_light(light), met.front, dot(met.wo, met.n), met.wo);
        }
    }
    put(light);
    put(pdf);
    put(L);
}
