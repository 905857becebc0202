// For selftest/traversal.h: item (ray). The nearest hit by the BVH and by testing every primitive, and whether the ray
// is occluded before the hit, just behind it, and anywhere. The scene has no instances.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 9u
#include "probes/items.glsl"
#include "scene/traversal.glsl"

Hit brute_force(Ray ray) {
    RayShear shear = ray_shear(ray.d, reciprocals(ray.d));
    Hit hit = hit_none(FLOAT_MAX);
    Candidate candidate = candidate_none();
    uint depth = 0u;
    for (uint i = 0u; i < primitive_count; ++i) {
        meet(i, primitive_hit(ray, shear, scene_primitive(i), i, NO_INSTANCE), hit, candidate);
        for (int k = 0; k < 2; ++k)
            decide(ray, shear, false, false, hit, candidate, depth);
    }
    return hit;
}

void main() {
    if (past_end()) return;
    Ray ray = Ray(item_floats(0u).xyz, item_floats(1u).xyz);
    Hit hit = bvh_intersect(ray);
    put(hit.t);
    put(hit_id(hit));
    put(is_hit(hit) ? hit_coordinates(ray, scene_primitive(hit_primitive(hit)), hit) : vec2(0.0));
    Hit reference = brute_force(ray);
    put(reference.t);
    put(hit_id(reference));
    put(uint(bvh_occluded(ray, hit.t)));
    put(uint(bvh_occluded(ray, is_hit(hit) ? uintBitsToFloat(floatBitsToUint(hit.t) + 1u) : FLOAT_MAX)));
    put(uint(bvh_occluded(ray, FLOAT_MAX)));
}
