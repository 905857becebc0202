// What the integrator needs to know of the point that a ray met.
#ifndef SCENE_INTERACTION_GLSL
#define SCENE_INTERACTION_GLSL

#include "base/frame.glsl"
#include "scene/scene_data.glsl"
#include "scene/traversal.glsl"

layout(constant_id = CONSTANT_HAS_NORMALS) const bool HAS_NORMALS = true;

// World space [m]. Both normals are unit vectors on the viewer's side of the surface; which side that is, the
// geometric normal alone decides.
struct Interaction {
    vec3 p;
    vec3 wo;  // Towards the viewer, unit.
    vec3 n;   // Geometric normal.
    vec3 ns;  // Shading normal.
    bool front;  // The viewer sees the front side.
    uint material;
    uint light;  // Light that the surface belongs to, or NO_LIGHT.
};

Interaction interaction_at(Ray ray, Hit hit) {
    Primitive t = scene_primitive(hit.primitive);
    float b0 = 1.0 - hit.b.x - hit.b.y;
    Interaction s;
    s.p = b0 * t.a + hit.b.x * t.b + hit.b.y * t.c;
    s.wo = -normalize(ray.d);
    s.n = normalize(cross(t.b - t.a, t.c - t.a));
    s.ns = s.n;
    if (HAS_NORMALS) {
        uvec4 normals = scene_normals(hit.primitive);
        if (normals.w != 0u) {
            vec3 ns = b0 * octahedral_unpack(normals.x) + hit.b.x * octahedral_unpack(normals.y) +
                      hit.b.y * octahedral_unpack(normals.z);
            float length_squared = dot(ns, ns);
            if (length_squared > 0.0) s.ns = ns * inversesqrt(length_squared);
            if (dot(s.ns, s.n) < 0.0) s.ns = -s.ns;
        }
    }
    s.front = dot(s.wo, s.n) >= 0.0;
    if (!s.front) {
        s.n = -s.n;
        s.ns = -s.ns;
    }
    s.material = t.material;
    s.light = t.light;
    return s;
}

// A ray that leaves the surface at s.p in that direction.
Ray interaction_spawn_ray(Interaction s, vec3 wi) {
    return Ray(offset_origin(s.p, dot(wi, s.n) >= 0.0 ? s.n : -s.n), wi);
}

#endif
