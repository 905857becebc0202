// For selftest/spheres.h: item (ray; direction, side). The hit of the ray, and the hit of a second ray that leaves from
// there in that direction, turned to the viewer's side (side 0) or to the other (1). If the first ray misses,
// everything except its t is 0.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 3u
#define RESULT_WORDS 17u
#include "probes/items.glsl"
#include "scene/interaction.glsl"

void main() {
    if (past_end()) return;
    Ray ray = Ray(item_floats(0u).xyz, item_floats(1u).xyz);
    Hit hit = bvh_intersect(ray);
    put(hit.t);
    if (!is_hit(hit)) {
        while (values_put < RESULT_WORDS)
            put(0u);
        return;
    }
    Interaction s = interaction_at(ray, hit);
    put(s.p);
    put(s.error);
    put(s.n);
    put(uint(s.front));
    bool viewers_side = item(2u).w == 0u;
    vec3 wi = item_floats(2u).xyz;
    if (dot(wi, s.n) > 0.0 != viewers_side) wi = -wi;
    Ray next = Ray(vertex_spawn_origin(interaction_vertex(s), viewers_side), wi);
    put(next.o);
    put(next.d);
    put(bvh_intersect(next).t);
    put(hit_id(hit));
}
