// Ray against primitive: one line per kind.
#ifndef SCENE_PRIMITIVE_GLSL
#define SCENE_PRIMITIVE_GLSL

#include "scene/disk.glsl"
#include "scene/sphere.glsl"
#include "scene/triangle.glsl"
#include "shared/primitive.h"

// Bit i: the scene has a primitive of kind i.
layout(constant_id = CONSTANT_PRIMITIVES) const uint PRIMITIVES = 0xFFFFFFFFu;

// True if a primitive of that kind is of kind `asked`. Kinds that the scene does not have leave no code in the kernel,
// and a scene of one kind needs no branch.
bool is_kind(uint kind, const uint asked) {
    if ((PRIMITIVES & 1u << asked) == 0u) return false;
    return (PRIMITIVES & ~(1u << asked)) == 0u || kind == asked;
}

// The nearest primitive along a ray. Among equally near ones the first in leaf order wins, whatever the order of
// visits.
struct Hit {
    float t;     // In lengths of ray.d.
    uint place;  // Twice its position in leaf order, and 1 more for the second of two triangles.
    vec2 b;      // Surface coordinates: of a triangle the barycentric ones of its second and third vertex, of a disk
                 // those in its axes.
};

// Keeps the hit of the primitive at that position if it is nearer than `hit`.
void primitive_intersect(Ray ray, RayShear shear, Primitive p, uint position, inout Hit hit) {
    vec4 found;  // t, which is not above 0 where the ray misses; b; which of two triangles.
    if (is_kind(p.kind, PRIMITIVE_SPHERE)) {
        found = vec4(sphere_intersect(ray, p.a, p.b.x), 0.0, 0.0, 0.0);
    } else if (is_kind(p.kind, PRIMITIVE_DISK)) {
        found = vec4(disk_intersect(ray, p.a, p.b, p.c), 0.0);
    } else {
        found = triangles_intersect(ray, shear, p.a, p.b, p.c, p.d);
    }
    uint place = 2u * position + uint(found.w);
    if (found.x > 0.0 && (found.x < hit.t || (found.x == hit.t && place < hit.place))) {
        hit = Hit(found.x, place, found.yz);
    }
}

#endif
