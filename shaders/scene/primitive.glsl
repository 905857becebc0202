// Ray against primitive: one line per kind.
#ifndef SCENE_PRIMITIVE_GLSL
#define SCENE_PRIMITIVE_GLSL

#include "scene/disk.glsl"
#include "scene/sphere.glsl"
#include "scene/triangle.glsl"
#include "shared/kernel_constants.h"
#include "shared/primitive.h"

// True if a primitive of that kind is of kind `asked`. Kinds that the scene does not have leave no code in the kernel,
// and a scene of one kind needs no branch.
bool is_kind(uint kind, const uint asked) {
    if ((PRIMITIVES & 1u << asked) == 0u) return false;
    return (PRIMITIVES & ~(1u << asked)) == 0u || kind == asked;
}

// The nearest hit along a ray. Among equally near ones the first in leaf order wins, whatever the order of visits.
struct Hit {
    float t;    // In lengths of ray.d; without a hit, how far the ray was followed.
    int place;  // Twice its position in leaf order, plus 1 for the second of two triangles; negative: no hit.
};

Hit hit_none(float t_max) {
    return Hit(t_max, -1);
}

bool is_hit(Hit hit) {
    return hit.place >= 0;
}

// Position in leaf order of the primitive that was hit.
uint hit_primitive(Hit hit) {
    return uint(hit.place) / 2u;
}

// The second of two triangles was hit.
bool hit_second(Hit hit) {
    return (hit.place & 1) != 0;
}

// A hit of the primitive at that position.
Hit triangles_hit(TrianglesHit found, uint position) {
    return Hit(found.t, int(2u * position + uint(found.second)));
}

// Replaces `hit` with a hit of the primitive at that position in leaf order if that is nearer.
void primitive_intersect(Ray ray, RayShear shear, Primitive p, uint position, inout Hit hit) {
    Hit found = Hit(0.0, int(2u * position));
    if (is_kind(p.kind, PRIMITIVE_SPHERE)) {
        found.t = sphere_intersect(ray, p.a, p.b.x);
    } else if (is_kind(p.kind, PRIMITIVE_DISK)) {
        found.t = disk_intersect(ray, p.a, p.b, p.c).x;
    } else {
        found = triangles_hit(triangles_intersect(ray, shear, p.a, p.b, p.c, p.d), position);
    }
    if (found.t > 0.0 && (found.t < hit.t || (found.t == hit.t && found.place < hit.place))) hit = found;
}

// Surface coordinates of a hit of that primitive: for a triangle, the barycentric ones of its second and third vertex;
// for a disk, those along its axes. (Few hits need them, so traversal does not keep them.)
vec2 hit_coordinates(Ray ray, Primitive p, Hit hit) {
    if (is_kind(p.kind, PRIMITIVE_SPHERE)) return vec2(0.0);
    if (is_kind(p.kind, PRIMITIVE_DISK)) return disk_intersect(ray, p.a, p.b, p.c).yz;
    bool second = hit_second(hit);
    return triangle_coordinates(ray, p.a, second ? p.c : p.b, second ? p.d : p.c);
}

#endif
