// Heights on a surface, and the normals that they imply.
#ifndef SCENE_BUMP_GLSL
#define SCENE_BUMP_GLSL

#include "scene/interaction.glsl"
#include "scene/texture.glsl"

// Two directions in a surface, and the change of texture coordinates along them.
struct UvEdges {
    vec3 e1;
    vec3 e2;
    vec2 uv1;
    vec2 uv2;
};

// The directions in which u and v grow on a sphere of that radius, at the outer normal n. 0 at the poles.
UvEdges sphere_uv_edges(float radius, vec3 n) {
    const float POLE = 1e-30;  // Below the square of any nonzero distance from the axis.
    vec3 around = vec3(n.z, 0.0, -n.x);
    vec3 up = cross(n, around) * inversesqrt(max(dot(around, around), POLE));
    return UvEdges(2.0 * PI * radius * around, PI * radius * up, vec2(1.0, 0.0), vec2(0.0, 1.0));
}

// The edges of the triangle that was hit, or the axes of the disk, in the frame of the scene; for texture t's set of
// coordinates.
UvEdges uv_edges(TextureRecord t, Hit hit, vec3 n) {
    Primitive p = scene_primitive(hit_primitive(hit));
    if (is_kind(p.kind, PRIMITIVE_SPHERE)) return sphere_uv_edges(p.b.x, n);
    uvec4 ab, cd;
    scene_attributes(hit_primitive(hit), has_trait(t.traits, TEXTURE_UV1, TEXTURE_UV_SETS) ? UV1_WORD : 0u, ab, cd);
    vec2 a = uintBitsToFloat(ab.xy), b = uintBitsToFloat(ab.zw), c = uintBitsToFloat(cd.xy);
    if (is_kind(p.kind, PRIMITIVE_DISK)) return UvEdges(p.b, p.c, b - a, c - a);
    UvEdges edges = UvEdges(p.b - p.a, p.c - p.a, b - a, c - a);
    if (hit_second(hit)) edges = UvEdges(p.c - p.a, p.d - p.a, c - a, uintBitsToFloat(cd.zw) - a);
    if (is_instanced(hit.instance)) {
        Instance instance = scene_instance(hit.instance);
        edges.e1 = vector_to_scene(instance, edges.e1);
        edges.e2 = vector_to_scene(instance, edges.e2);
    }
    return edges;
}

// The shading normal of s on its front side, turned as by a displacement of the surface along it: by the channel of
// texture t times `scale`, in the frame of the scene.
// Ref: Mikkelsen 2010, Bump Mapping Unparametrized Surfaces on the GPU.
vec3 bumped_normal(TextureRecord t, float scale, Hit hit, Interaction s) {
    vec3 n = s.front ? s.ns : -s.ns;
    UvEdges edges = uv_edges(t, hit, s.front ? s.n : -s.n);
    vec2 slope =
        texture_slope(t, has_trait(t.traits, TEXTURE_UV1, TEXTURE_UV_SETS) ? s.attributes.uv1 : s.attributes.uv0);
    // The gradient along the surface rises along e1 and e2 as the heights do.
    vec3 along_e1 = cross(edges.e2, n), along_e2 = cross(n, edges.e1);
    float det = dot(edges.e1, along_e1);
    vec3 gradient = (scale / det) * (dot(slope, edges.uv1) * along_e1 + dot(slope, edges.uv2) * along_e2);
    float length_squared = 1.0 + dot(gradient, gradient);
    // If floats cannot hold the slope, the normal is unchanged.
    return det != 0.0 && length_squared < FLOAT_MAX ? inversesqrt(length_squared) * (n - gradient) : n;
}

#endif
