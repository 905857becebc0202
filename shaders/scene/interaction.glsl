// What the integrator needs to know about the point that a ray hit.
#ifndef SCENE_INTERACTION_GLSL
#define SCENE_INTERACTION_GLSL

#include "base/frame.glsl"
#include "scene/attributes.glsl"
#include "scene/scene_data.glsl"
#include "scene/traversal.glsl"

// In the frame of the scene. Both normals are unit vectors on the viewer's side of the surface; the geometric normal alone
// decides which side that is.
struct Interaction {
    vec3 p;
    vec3 wo;        // Towards the viewer, unit.
    vec3 n;         // Geometric normal.
    vec3 ns;        // Shading normal.
    bool front;     // The viewer sees the front side.
    float error;    // How far from p, along n, rays must begin.
    uint material;
    uint light;  // Light that the surface belongs to, or NO_LIGHT.
    Attributes attributes;
};

// The interpolated shading normal of the triangle that was hit, on the side of n.
vec3 shading_normal(Hit hit, vec2 b, vec3 n) {
    uvec4 normals = scene_normals(hit_primitive(hit));
    if (hit_second(hit)) normals.yz = normals.zw;
    vec3 ns = (1.0 - b.x - b.y) * octahedral_unpack(normals.x) + b.x * octahedral_unpack(normals.y) +
              b.y * octahedral_unpack(normals.z);
    float length_squared = dot(ns, ns);
    if (length_squared == 0.0) return n;
    ns *= inversesqrt(length_squared);
    return dot(ns, n) < 0.0 ? -ns : ns;
}

// The point that the ray hit; is_hit(hit) must hold.
Interaction interaction_at(Ray ray, Hit hit) {
    Primitive primitive = scene_primitive(hit_primitive(hit));
    Surface surface = scene_surface(hit_primitive(hit));
    vec3 a = primitive.a;
    vec2 at = hit_coordinates(ray, primitive, hit);
    Interaction s;
    if (is_kind(primitive.kind, PRIMITIVE_SPHERE)) {
        s.n = normalize((ray.o - a) + hit.t * ray.d);
        s.p = a + primitive.b.x * s.n;
    } else if (is_kind(primitive.kind, PRIMITIVE_DISK)) {
        s.n = normalize(cross(primitive.b, primitive.c));
        s.p = a + at.x * primitive.b + at.y * primitive.c;
    } else {
        bool second = hit_second(hit);
        vec3 e1 = (second ? primitive.c : primitive.b) - a;
        vec3 e2 = (second ? primitive.d : primitive.c) - a;
        s.n = normalize(cross(e1, e2));
        s.p = a + (at.x * e1 + at.y * e2);  // Where triangles are small, no sum but the last rounds by much.
    }
    s.ns = s.n;
    if (HAS_NORMALS && surface.has_normals != 0u) s.ns = shading_normal(hit, at, s.n);
    s.attributes = attributes_at(AttributePlace(hit_primitive(hit), hit_second(hit), at, is_kind(primitive.kind, PRIMITIVE_SPHERE), s.n));
    s.wo = -normalize(ray.d);
    s.front = dot(s.wo, s.n) >= 0.0;
    if (!s.front) {
        s.n = -s.n;
        s.ns = -s.ns;
    }
    s.error = surface.error;
    s.material = surface.material;
    s.light = surface.light;
    return s;
}

// The origin of a ray that leaves the surface on the viewer's side, or on the other.
vec3 interaction_spawn_origin(Interaction s, bool viewers_side) {
    return s.p + (viewers_side ? s.error : -s.error) * s.n;
}

#endif
