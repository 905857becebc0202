// Ray against primitive: one line per kind.
#ifndef SCENE_PRIMITIVE_GLSL
#define SCENE_PRIMITIVE_GLSL

#include "scene/disk.glsl"
#include "scene/instance.glsl"
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

// The nearest hit along a ray. Among equally near ones the first wins, by instance and then in leaf order, independent
// of the order of visits.
struct Hit {
    float t;        // In lengths of ray.d; without a hit, the limit of the search.
    int place;      // Twice its position in leaf order, plus 1 for the second of two triangles; negative: no hit.
    uint instance;  // The place of its record among the nodes, or NO_INSTANCE.
};

Hit hit_none(float t_max) {
    return Hit(t_max, -1, NO_INSTANCE);
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

// The surface that was hit, with its place among all surfaces and the material of its instance.
Surface hit_surface(Hit hit) {
    Surface surface = scene_surface(hit_primitive(hit));
    if (is_instanced(hit.instance)) {
        Instance instance = scene_instance(hit.instance);
        surface.id += instance.first_id;
        surface.material = instance.material;
    }
    return surface;
}

// A hit of the primitive at that position, of that instance or of none.
Hit triangles_hit(TrianglesHit found, uint position, uint instance) {
    return Hit(found.t, int(2u * position + uint(found.second)), instance);
}

// Whether `found` is a hit that is nearer than `hit`.
bool is_nearer(Hit found, Hit hit) {
    bool before = found.place < hit.place;
    if (INSTANCED && found.instance != hit.instance) before = found.instance < hit.instance;
    return found.t > 0.0 && (found.t < hit.t || (found.t == hit.t && before));
}

// The first hit of the primitive at that position in leaf order, of that instance or of none, by a ray in its space;
// the hit's t is not above 0 if the ray misses.
Hit primitive_hit(Ray ray, RayShear shear, Primitive p, uint position, uint instance) {
    if (is_kind(p.kind, PRIMITIVE_SPHERE))
        return Hit(sphere_intersect(ray, p.a, p.b.x).x, int(2u * position), instance);
    if (is_kind(p.kind, PRIMITIVE_DISK)) return Hit(disk_intersect(ray, p.a, p.b, p.c).x, int(2u * position), instance);
    return triangles_hit(triangles_intersect(ray, shear, p.a, p.b, p.c, p.d), position, instance);
}

// The hit beyond that first one: of the other triangle, or of the sphere's far side.
Hit primitive_second_hit(Ray ray, RayShear shear, Primitive p, Hit first) {
    if (is_kind(p.kind, PRIMITIVE_SPHERE)) return Hit(sphere_intersect(ray, p.a, p.b.x).y, first.place, first.instance);
    if (is_kind(p.kind, PRIMITIVE_DISK)) return Hit(-1.0, first.place, first.instance);
    // The same triangle twice, so that the other triangle's rounding has no influence.
    bool second = !hit_second(first);
    vec3 b = second ? p.c : p.b;
    vec3 c = second ? p.d : p.c;
    return Hit(triangles_intersect(ray, shear, p.a, b, c, c).t, first.place ^ 1, first.instance);
}

// Surface coordinates of a hit of that primitive: for a triangle, the barycentric ones of its second and third vertex;
// for a disk, those along its axes. The ray is in the primitive's space. (Few hits need them, so traversal does not
// keep them.)
vec2 hit_coordinates(Ray ray, Primitive p, Hit hit) {
    if (is_kind(p.kind, PRIMITIVE_SPHERE)) return vec2(0.0);
    if (is_kind(p.kind, PRIMITIVE_DISK)) return disk_intersect(ray, p.a, p.b, p.c).yz;
    bool second = hit_second(hit);
    return triangle_coordinates(ray, p.a, second ? p.c : p.b, second ? p.d : p.c);
}

#endif
