// Triangles with a normal at each vertex, and the curved surface that these normals describe.
//
// Where a triangle faces away from a light but its shading normal does not, the triangle would shadow itself, and the
// terminator would follow the mesh in steps. So the rays of light samples and of BSDF samples begin above the curved
// surface, from where no direction above the horizon of the shading normal meets a convex mesh. The point lies on the
// ray that found the triangle, where nothing is in between, so no light leaks through objects that touch the mesh. The
// height is 0 where normals do not diverge, falls with the square of the triangle's size, and is the same on both sides
// of an edge.
// Ref: Hanika 2021, Hacking the Shadow Terminator, in Ray Tracing Gems II, which lifts the point along its normal, by
// the vertices' tangent planes.
#ifndef SCENE_SMOOTH_GLSL
#define SCENE_SMOOTH_GLSL

#include "scene/instance.glsl"
#include "scene/primitive.glsl"
#include "scene/scene_data.glsl"

// Whether shading normals determine horizons, as above.
const bool SMOOTH = HAS_NORMALS && SMOOTH_TERMINATOR;

// Unit normals on the front side, in the frame of the scene.
struct VertexNormals {
    vec3 a;
    vec3 b;
    vec3 c;
};

vec3 vertex_normal(uint bits, Hit hit, Instance instance) {
    vec3 n = octahedral_unpack(bits);
    return is_instanced(hit.instance) ? normalize(normal_to_scene(instance, n)) : n;
}

// The normals of the triangle that was hit.
VertexNormals vertex_normals(Hit hit, Instance instance) {
    uvec4 normals = scene_normals(hit_primitive(hit));
    if (hit_second(hit)) normals.yz = normals.zw;
    return VertexNormals(vertex_normal(normals.x, hit, instance), vertex_normal(normals.y, hit, instance),
                         vertex_normal(normals.z, hit, instance));
}

// The interpolated shading normal at surface coordinates b, on the side of the unit normal n; n if they cancel.
vec3 shading_normal(VertexNormals normals, vec2 b, vec3 n) {
    vec3 ns = (1.0 - b.x - b.y) * normals.a + b.x * normals.b + b.y * normals.c;
    float length_squared = dot(ns, ns);
    if (length_squared == 0.0) return n;
    ns *= inversesqrt(length_squared);
    return dot(ns, n) < 0.0 ? -ns : ns;
}

// The height above the triangle, with these edges from its first vertex, at which light begins, at surface coordinates
// b: slightly above the curved surface, as far as that bulges towards `side` (1: where the normals point; -1: the
// other). To the second order, a surface with the normals n and n' at the ends of an edge e rises s (1 - s) / 2 e . (n'
// - n) above it.
float smooth_height(VertexNormals normals, vec3 e1, vec3 e2, vec2 b, float side) {
    const float MARGIN = 1.3;  // For higher orders: an octahedron for a sphere needs 1.27.
    float a = 1.0 - b.x - b.y;
    float sum = a * b.x * max(side * dot(e1, normals.b - normals.a), 0.0) +
                a * b.y * max(side * dot(e2, normals.c - normals.a), 0.0) +
                b.x * b.y * max(side * dot(e2 - e1, normals.c - normals.b), 0.0);
    return 0.5 * MARGIN * sum;
}

// The vector back along a ray of that length from its hit to the point at that height above the triangle, measured
// along the shading normal. At most half of the ray, and limited as at MIN_COSINE if the ray grazes the surface.
vec3 smooth_lift(float height, vec3 wo, vec3 ns, float ray_length) {
    const float MIN_COSINE = 0.25;
    return clamp(height / max(dot(wo, ns), MIN_COSINE), 0.0, 0.5 * ray_length) * wo;
}

#endif
