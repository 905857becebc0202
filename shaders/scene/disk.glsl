// Ray against disk.
#ifndef SCENE_DISK_GLSL
#define SCENE_DISK_GLSL

#include "base/ray.glsl"

// Distance t in lengths of ray.d, and (x, y) of the point center + x e1 + y e2 that the ray hits. It misses if t is not
// above 0, as when x^2 + y^2 > 1. (A copy of this code may be compiled to round a hit at the rim outwards: x and y are
// still valid.)
vec3 disk_intersect(Ray ray, vec3 center, vec3 e1, vec3 e2) {
    vec3 n = cross(e1, e2);
    float approach = dot(ray.d, n);
    if (approach == 0.0) return vec3(-1.0);
    precise float t = dot(center - ray.o, n) / approach;
    vec3 p = (ray.o - center) + t * ray.d;
    vec2 b = vec2(dot(cross(p, e2), n), dot(cross(e1, p), n)) / dot(n, n);
    return vec3(dot(b, b) <= 1.0 ? t : -1.0, b);
}

#endif
