// For escape_test.cpp: item (point, spread; first counter, count). Shoots that many rays from around the point, within
// the mesh, and counts those that miss; writes how many were shot and the last one that escaped. Rays are made here,
// from a hash: there are more of them than a test could send.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 8u
#include "base/sampler.glsl"
#include "base/warp.glsl"
#include "probes/items.glsl"
#include "scene/traversal.glsl"

// A random vertex of a random pair of triangles, or a random point of one of its edges.
vec3 feature_point(uvec3 random) {
    uint index, rest;
    umulExtended(random.x, primitive_count, index, rest);
    Primitive t = scene_primitive(index);
    uint corner = random.y % 5u;  // 4 is the common edge.
    vec3 from = corner == 0u ? t.a : corner == 1u ? t.b : corner == 2u ? t.c : corner == 3u ? t.d : t.a;
    vec3 to = corner == 0u ? t.b : corner == 1u ? t.c : corner == 2u ? t.d : corner == 3u ? t.a : t.c;
    return (random.y & 4096u) == 0u ? from : mix(from, to, unit_float(random.z));
}

// A ray from the cube of half edge `spread` around the point: every other one goes anywhere, the rest towards vertices
// and edges, half of these with unit length.
Ray random_ray(vec3 point, float spread, uint counter) {
    uvec4 of_origin = hash_pcg4d(uvec4(counter, 1u, 2u, 3u));
    uvec4 of_direction = hash_pcg4d(uvec4(counter, 4u, 5u, 6u));
    vec3 o = point + spread * (2.0 * vec3(unit_float(of_origin.xy), unit_float(of_origin.z)) - 1.0);
    if ((counter & 1u) == 0u) return Ray(o, warp_sphere(unit_float(of_direction.xy)));
    vec3 d = feature_point(of_direction.xyz) - o;
    return Ray(o, (of_origin.w & 1u) == 0u ? d : normalize(d));
}

void main() {
    if (past_end()) return;
    uint first = item(1u).x;
    uint count = item(1u).y;
    uint escapes = 0u;
    Ray escaped = Ray(vec3(0.0), vec3(0.0));
    uint shot = 0u;
    while (shot < count) {
        Ray ray = random_ray(item_floats(0u).xyz, item_floats(0u).w, first + shot);
        if (!is_hit(bvh_intersect(ray))) {
            ++escapes;
            escaped = ray;
        }
        ++shot;
    }
    put(shot);
    put(escapes);
    put(escaped.o);
    put(escaped.d);
}
