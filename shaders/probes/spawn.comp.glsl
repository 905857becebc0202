// For spawn_test.cpp: item (triangle; b1, b2; error; direction). Spawns a ray from the point b1, b2 of the triangle and
// intersects it with that triangle; writes the distance, and the ray's origin and the triangle's normal.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 4u
#define RESULT_WORDS 7u
#include "probes/items.glsl"
#include "scene/triangle.glsl"

void main() {
    if (past_end()) return;
    vec3 v0 = item_floats(0u).xyz;
    vec3 v1 = item_floats(1u).xyz;
    vec3 v2 = item_floats(2u).xyz;
    vec2 b = vec2(item_floats(0u).w, item_floats(1u).w);
    vec3 p = v0 + (b.x * (v1 - v0) + b.y * (v2 - v0));
    vec3 n = normalize(cross(v1 - v0, v2 - v0));
    vec3 wi = item_floats(3u).xyz;
    if (dot(wi, n) < 0.0) n = -n;
    Ray ray = Ray(p + item_floats(2u).w * n, wi);
    put(triangles_intersect(ray, ray_shear(ray.d, reciprocals(ray.d)), v0, v1, v2, v2).t);
    put(ray.o);
    put(n);
}
