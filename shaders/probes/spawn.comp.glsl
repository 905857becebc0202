// For spawn_test.cpp: item (triangle; b1, b2; direction). Spawns a ray from the point b1, b2 of the triangle and
// intersects it with that triangle; writes the distance, and the ray's origin and the triangle's normal.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 4u
#define RESULT_WORDS 7u
#include "probes/items.glsl"
#include "scene/triangle.glsl"
#include "shared/primitive.h"

void main() {
    if (past_end()) return;
    Primitive t = primitive_unpack(item(0u), item(1u), item(2u));
    vec2 b = vec2(item_floats(0u).w, item_floats(1u).w);
    vec3 p = (1.0 - b.x - b.y) * t.a + b.x * t.b + b.y * t.c;
    vec3 n = normalize(cross(t.b - t.a, t.c - t.a));
    vec3 wi = item_floats(3u).xyz;
    if (dot(wi, n) < 0.0) n = -n;
    Ray ray = Ray(offset_origin(p, n), wi);
    put(triangle_intersect(ray, ray_shear(ray.d), t.a, t.b, t.c).x);
    put(ray.o);
    put(n);
}
