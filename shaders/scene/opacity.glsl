// Surfaces that some rays pass as if they were not there: masks, and opacity below 1.
#ifndef SCENE_OPACITY_GLSL
#define SCENE_OPACITY_GLSL

#include "base/hash.glsl"
#include "base/sampler.glsl"
#include "scene/material.glsl"
#include "scene/primitive.glsl"

const bool HAS_PASSABLE = (TEXTURED & TEXTURED_PASSABLE) != 0u;

// A number in [0, 1) that is random for each ray and hit, independent of the order in which they are found: a hash of
// the bits of the ray in the primitive's space, of the surface's id in the scene, and of whether the hit is the first
// one of its primitive. (A sample's rays differ from those of every other sample.)
float opacity_random(Ray ray, uint id, bool first) {
    uvec4 v = hash_pcg4d(uvec4(floatBitsToUint(ray.d), id));
    return unit_float(hash_pcg4d(v ^ uvec4(floatBitsToUint(ray.o), uint(first))).x);
}

// Whether the ray hits the primitive from behind; `n` points from a sphere's centre to the hit.
bool is_hit_from_behind(Ray ray, Primitive p, Hit hit, vec3 n) {
    if (is_kind(p.kind, PRIMITIVE_DISK)) n = cross(p.b, p.c);
    if (is_kind(p.kind, PRIMITIVE_TRIANGLES))
        n = hit_second(hit) ? cross(p.c - p.a, p.d - p.a) : cross(p.b - p.a, p.c - p.a);
    return dot(n, ray.d) > 0.0;
}

// Whether the ray, in the primitive's space, ends at a hit of that primitive, the first one there or not.
bool is_stopped(Ray ray, Primitive p, Hit hit, bool first) {
    Surface surface = hit_surface(hit);
    vec3 n = ray.o + hit.t * ray.d - p.a;
    if ((PRINCIPLED & PRINCIPLED_HAS_CULLED) != 0u && scene_material_textures(surface.material).culled != 0u &&
        is_hit_from_behind(ray, p, hit, n)) {
        return false;
    }
    if ((TEXTURED & TEXTURED_OPACITY) == 0u) return true;
    AttributePlace place = AttributePlace(hit_primitive(hit), hit_second(hit), hit_coordinates(ray, p, hit),
                                          is_kind(p.kind, PRIMITIVE_SPHERE), n);
    float opacity = material_opacity(surface.material, attributes_at(place));
    if (opacity >= 1.0 || opacity <= 0.0) return opacity >= 1.0;
    return opacity_random(ray, hit_second(hit) ? surface.id.y : surface.id.x, first) < opacity;
}

// A hit that may stop the ray, nearer than any hit that is known to stop it.
struct Candidate {
    Hit hit;     // No hit if there is no candidate.
    bool first;  // It is the first hit of its primitive.
};

Candidate candidate_none() {
    return Candidate(hit_none(0.0), true);
}

// The primitive at that position in leaf order has its first hit there: replaces the ray's nearest hit, or, if some
// rays pass the primitive, the candidate, if it is nearer than the nearest hit.
void meet(uint position, Hit found, inout Hit hit, inout Candidate candidate) {
    if (!is_nearer(found, hit)) return;
    if (HAS_PASSABLE && scene_surface(position).passable != 0u) {
        candidate = Candidate(found, true);
    } else {
        hit = found;
    }
}

// Makes the candidate the nearest hit if it stops the ray; otherwise the second hit of its primitive is the next
// candidate, if it may stop the ray.
void decide(Ray ray, RayShear shear, inout Hit hit, inout Candidate candidate) {
    if (!HAS_PASSABLE || !is_hit(candidate.hit)) return;
    Hit found = candidate.hit;
    Primitive p = scene_primitive(hit_primitive(found));
    if (is_stopped(ray, p, found, candidate.first)) {
        hit = found;
        candidate = candidate_none();
        return;
    }
    Hit second = primitive_second_hit(ray, shear, p, found);
    bool goes_on = candidate.first && is_nearer(second, hit);
    candidate = candidate_none();
    if (goes_on) candidate = Candidate(second, false);
}

#endif
