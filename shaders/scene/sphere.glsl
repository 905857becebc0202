// Ray against sphere.
#ifndef SCENE_SPHERE_GLSL
#define SCENE_SPHERE_GLSL

#include "base/ray.glsl"

// The distances t > 0 in lengths of ray.d at which the ray hits, the smaller one first; the ray misses if they are not
// above 0. `precise` makes every copy of the code find the same distances.
//
// Ref: Haines, Guenther and Akenine-Moeller 2019, Precision Improvements for Ray/Sphere Intersection (Ray Tracing Gems,
// chapter 7): the discriminant from the point of the line next to the centre, and the root that cancels by Vieta's
// rule.
vec2 sphere_intersect(Ray ray, vec3 center, float radius) {
    vec3 f = ray.o - center;
    float a = dot(ray.d, ray.d);
    float b = -dot(f, ray.d);
    vec3 nearest = f + (b / a) * ray.d;
    precise float discriminant = radius * radius - dot(nearest, nearest);
    if (discriminant <= 0.0) return vec2(-1.0);  // This ensures that q is not 0.
    float root = sqrt(a * discriminant);
    float q = b >= 0.0 ? b + root : b - root;
    precise float t0 = (dot(f, f) - radius * radius) / q;
    precise float t1 = q / a;
    return min(t0, t1) > 0.0 ? vec2(min(t0, t1), max(t0, t1)) : vec2(max(t0, t1), -1.0);
}

#endif
