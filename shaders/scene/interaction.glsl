// The integrator's data about the point that a ray hit.
#ifndef SCENE_INTERACTION_GLSL
#define SCENE_INTERACTION_GLSL

#include "base/frame.glsl"
#include "scene/attributes.glsl"
#include "scene/scene_data.glsl"
#include "scene/smooth.glsl"
#include "scene/traversal.glsl"
#include "scene/vertex.glsl"

// In the frame of the scene. Both normals are unit vectors on the viewer's side of the surface; the geometric normal
// alone decides which side the viewer is on.
struct Interaction {
    vec3 p;
    vec3 wo;      // Towards the viewer, unit.
    vec3 n;       // Geometric normal.
    vec3 ns;      // Shading normal.
    bool front;   // The viewer sees the front side.
    float error;  // How far from the surface, along n, rays must begin.
    vec3 lift;    // From p to where light that stays on the viewer's side begins: see scene/smooth.glsl.
    uint material;
    uint light;  // Light of the surface, or NO_LIGHT,
    uint lamp;   // and the lamp that has it, or NO_LIGHT.
    Attributes attributes;
};

// The interpolated shading normal of the triangle that was hit, on the viewer's side, and the lift of light from it.
// The ray is `ray_length` long.
void smooth_shading(inout Interaction s, Hit hit, Instance instance, Primitive primitive, vec2 b, float ray_length) {
    VertexNormals normals = vertex_normals(hit, instance);
    s.ns = shading_normal(normals, b, s.n);
    if (!SMOOTH) return;
    bool second = hit_second(hit);
    vec3 e1 = (second ? primitive.c : primitive.b) - primitive.a;
    vec3 e2 = (second ? primitive.d : primitive.c) - primitive.a;
    if (is_instanced(hit.instance)) {
        e1 = vector_to_scene(instance, e1);
        e2 = vector_to_scene(instance, e2);
    }
    float side = dot(normals.a + normals.b + normals.c, s.n) < 0.0 ? -1.0 : 1.0;
    s.lift = smooth_lift(smooth_height(normals, e1, e2, b, side), s.wo, s.ns, ray_length);
}

// Transforms a point in the space of an instance's mesh to the frame of the scene.
void bring_to_scene(Instance i, inout Interaction s) {
    s.p = i.centre + vector_to_scene(i, s.p);
    vec3 n = normal_to_scene(i, s.n);
    float inv_length = inversesqrt(dot(n, n));
    s.n = inv_length * n;
    s.error = inv_length * s.error + i.error;
    if ((ATTRIBUTES & ATTRIBUTE_TANGENT) != 0u) {
        vec4 t = s.attributes.tangent;
        vec3 along = vector_to_scene(i, t.xyz);
        // Keeps its length, also if that is 0.
        along *= sqrt(dot(t.xyz, t.xyz) / max(dot(along, along), 1e-36));
        s.attributes.tangent = vec4(along, instance_determinant(i) < 0.0 ? -t.w : t.w);
    }
}

// The point that the ray hit; is_hit(hit) must hold.
Interaction interaction_at(Ray ray, Hit hit) {
    Primitive primitive = scene_primitive(hit_primitive(hit));
    Surface surface = hit_surface(hit);
    Instance instance;
    vec3 wo = -normalize(ray.d);
    float ray_length = hit.t * length(ray.d);
    if (is_instanced(hit.instance)) {
        instance = scene_instance(hit.instance);
        ray = ray_to_mesh(instance, ray);
    }
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
        s.p = a + (at.x * e1 + at.y * e2);  // If triangles are small, only the last sum rounds by much.
    }
    s.attributes = attributes_at(
        AttributePlace(hit_primitive(hit), hit_second(hit), at, is_kind(primitive.kind, PRIMITIVE_SPHERE), s.n));
    s.error = surface.error;
    if (is_instanced(hit.instance)) bring_to_scene(instance, s);
    s.wo = wo;
    s.front = dot(s.wo, s.n) >= 0.0;
    if (!s.front) s.n = -s.n;
    s.ns = s.n;
    s.lift = vec3(0.0);
    if (HAS_NORMALS && surface.has_normals != 0u) {
        smooth_shading(s, hit, instance, primitive, at, ray_length);
    }
    s.material = surface.material;
    s.light = surface.light;
    s.lamp = NO_LIGHT;
    if (HAS_LAMPS && is_instanced(hit.instance) && s.light != NO_LIGHT) {
        s.lamp = instance.lamp;
        s.light += scene_lamp(s.lamp).first;
    }
    return s;
}

Vertex interaction_vertex(Interaction s) {
    return Vertex(s.p, s.n, s.error, s.lift);
}

#endif
