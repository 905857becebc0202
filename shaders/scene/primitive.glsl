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

// Distance t in lengths of ray.d and the surface coordinates of the point there: of a triangle the barycentric ones of
// b and c, of a disk those in its axes; t is not above 0 where the ray misses.
vec3 primitive_intersect(Ray ray, RayShear shear, Primitive p) {
    if (is_kind(p.kind, PRIMITIVE_SPHERE)) return vec3(sphere_intersect(ray, p.a, p.b.x), 0.0, 0.0);
    if (is_kind(p.kind, PRIMITIVE_DISK)) return disk_intersect(ray, p.a, p.b, p.c);
    return triangle_intersect(ray, shear, p.a, p.b, p.c);
}

#endif
