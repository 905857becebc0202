// Surfaces that some rays pass as if they were not there: masks, and opacity below 1.
#ifndef SCENE_OPACITY_GLSL
#define SCENE_OPACITY_GLSL

#include "base/hash.glsl"
#include "base/sampler.glsl"
#include "scene/material.glsl"
#include "scene/primitive.glsl"

const bool HAS_OPACITY = (TEXTURED & TEXTURED_OPACITY) != 0u;

// A number in [0, 1) that is random for each ray and hit, whatever the order in which these are found: a hash of the
// bits of the ray, of the surface's id in the scene, and of whether the hit is the first one of its primitive. (A
// sample's rays differ from those of every other sample.)
float opacity_random(Ray ray, uint id, bool first) {
    uvec4 v = hash_pcg4d(uvec4(floatBitsToUint(ray.d), id));
    return unit_float(hash_pcg4d(v ^ uvec4(floatBitsToUint(ray.o), uint(first))).x);
}

// Whether the ray ends at a hit of that primitive, the first one there or not.
bool is_stopped(Ray ray, Primitive p, Hit hit, bool first) {
    Surface surface = scene_surface(hit_primitive(hit));
    vec3 n = ray.o + hit.t * ray.d - p.a;
    AttributePlace place = AttributePlace(hit_primitive(hit), hit_second(hit), hit_coordinates(ray, p, hit),
                                          is_kind(p.kind, PRIMITIVE_SPHERE), n);
    float opacity = material_opacity(surface.material, attributes_at(place));
    if (opacity >= 1.0 || opacity <= 0.0) return opacity >= 1.0;
    return opacity_random(ray, hit_second(hit) ? surface.id.y : surface.id.x, first) < opacity;
}

// Replaces `hit` with the nearest hit of the primitive at that position in leaf order if that is nearer.
void primitive_intersect(Ray ray, RayShear shear, Primitive p, uint position, inout Hit hit) {
    Hit found = primitive_hit(ray, shear, p, position);
    if (!HAS_OPACITY) {
        if (is_nearer(found, hit)) hit = found;
        return;
    }
    for (int i = 0; i < 2 && is_nearer(found, hit); ++i) {
        if (is_stopped(ray, p, found, i == 0)) {
            hit = found;
            return;
        }
        found = primitive_second_hit(ray, shear, p, found);
    }
}

#endif
