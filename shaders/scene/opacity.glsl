// Surfaces that some rays pass as if they were not there: masks, and opacity below 1. Where opacity is between 0 and 1,
// a path's ray ends or passes by chance; a shadow ray passes and is dimmed, which has the same mean without the noise.
#ifndef SCENE_OPACITY_GLSL
#define SCENE_OPACITY_GLSL

#include "base/exponential.glsl"
#include "base/hash.glsl"
#include "base/sampler.glsl"
#include "scene/material.glsl"
#include "scene/primitive.glsl"

const bool HAS_PASSABLE = (TEXTURED & TEXTURED_PASSABLE) != 0u;
const bool HAS_HIDDEN = (TEXTURED & TEXTURED_HIDDEN) != 0u;
const bool HAS_OPACITY = (TEXTURED & TEXTURED_OPACITY) != 0u;

// What dims a shadow ray is a whole number of these parts of an optical depth, so that the sum over the surfaces that
// it passes is independent of their order.
const float OPTICAL_DEPTH_PARTS = 16777216.0;
const uint OPTICAL_DEPTH_OPAQUE = 18u << 24u;  // Less than 2^-25 would pass.

// The optical depth of a surface of that opacity, -log(1 - opacity), in parts.
uint optical_depth(float opacity) {
    if (opacity >= 1.0) return OPTICAL_DEPTH_OPAQUE;
    return uint(OPTICAL_DEPTH_PARTS * -log1p_nonpositive(-max(opacity, 0.0)) + 0.5);
}

// The fraction of light that passes that optical depth, in parts.
float passed_fraction(uint depth) {
    return exp_nonpositive(float(depth) * (-1.0 / OPTICAL_DEPTH_PARTS));
}

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

// The opacity of a hit for the ray, in the primitive's space: 0 if the ray passes.
float hit_opacity(Ray ray, bool of_camera, Primitive p, Hit hit) {
    Surface surface = hit_surface(hit);
    if (HAS_HIDDEN && of_camera && scene_material_textures(surface.material).hidden != 0u) return 0.0;
    vec3 n = ray.o + hit.t * ray.d - p.a;
    if ((PRINCIPLED & PRINCIPLED_HAS_CULLED) != 0u && scene_material_textures(surface.material).culled != 0u &&
        is_hit_from_behind(ray, p, hit, n)) {
        return 0.0;
    }
    if (!HAS_OPACITY) return 1.0;
    AttributePlace place = AttributePlace(hit_primitive(hit), hit_second(hit), hit_coordinates(ray, p, hit),
                                          is_kind(p.kind, PRIMITIVE_SPHERE), n);
    return material_opacity(surface.material, attributes_at(place));
}

// Whether a path's ray, in the primitive's space, ends at a hit of that opacity, the first one of its primitive or not.
bool is_stopped(Ray ray, Hit hit, float opacity, bool first) {
    if (!HAS_OPACITY || opacity >= 1.0 || opacity <= 0.0) return opacity >= 1.0;
    Surface surface = hit_surface(hit);
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
// candidate, if it may stop the ray. A shadow ray passes what is not opaque, which adds to `depth`, until that is so.
void decide(Ray ray, RayShear shear, bool shadow, bool of_camera, inout Hit hit, inout Candidate candidate,
            inout uint depth) {
    if (!HAS_PASSABLE || !is_hit(candidate.hit)) return;
    Hit found = candidate.hit;
    Primitive p = scene_primitive(hit_primitive(found));
    float opacity = hit_opacity(ray, of_camera, p, found);
    bool stopped;
    if (HAS_OPACITY && shadow) {
        depth += optical_depth(opacity);
        stopped = depth >= OPTICAL_DEPTH_OPAQUE;
    } else {
        stopped = is_stopped(ray, found, opacity, candidate.first);
    }
    if (stopped) {
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
