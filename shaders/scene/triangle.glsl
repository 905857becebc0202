// Ray against two triangles, watertight: two that share an edge leave no gap between them.
//
// Ref: Woop, Benthin and Wald 2013, Watertight Ray/Primitive Intersection. Their double-precision fallback for edge
// functions of 0 is not needed for watertightness: rounding is monotone, so a computed edge function can become 0 but
// never has the wrong sign; and 0 is inside on both sides of the edge.
#ifndef SCENE_TRIANGLE_GLSL
#define SCENE_TRIANGLE_GLSL

#include "base/math.glsl"
#include "base/ray.glsl"

// Values of a ray that are computed once for all triangles: the axis z along which it is longest, and the shear that
// turns it onto that axis.
struct RayShear {
    uint kz;
    vec3 s;
    vec2 inv;  // Reciprocals of the two shorter components.
};

// v with its components rotated cyclically so that component kz comes last.
vec3 turn(vec3 v, uint kz) {
    return kz == 0u ? v.yzx : kz == 1u ? v.zxy : v;
}

// inv_d: reciprocals(d).
RayShear ray_shear(vec3 d, vec3 inv_d) {
    vec3 a = abs(d);
    uint kz = a.x > a.y ? (a.x > a.z ? 0u : 2u) : (a.y > a.z ? 1u : 2u);
    vec3 e = turn(d, kz);
    vec3 inv = turn(inv_d, kz);
    return RayShear(kz, vec3(e.x / e.z, e.y / e.z, inv.z), inv.xy);
}

// A vertex in the coordinates of a ray: across the ray, and along it [lengths of d's longest component].
struct ShearedVertex {
    vec2 p;
    float z;
    vec2 t;  // The ray's t at each of the vertex's two other coordinates.
};

ShearedVertex shear_vertex(Ray ray, RayShear shear, vec3 v) {
    vec3 a = turn(v - ray.o, shear.kz);
    precise vec2 p = a.xy - shear.s.xy * a.z;
    return ShearedVertex(p, a.z, a.xy * shear.inv);
}

// Twice the signed area that the ray spans with an edge.
float edge_function(ShearedVertex a, ShearedVertex b) {
    precise float e = b.p.x * a.p.y - b.p.y * a.p.x;
    return e;
}

// Whether the ray hits the triangle with these edge functions, i.e. no two of them have opposite signs. It always
// misses a triangle without area.
bool edges_meet(vec3 e, float det) {
    return !(any_negative(e) && any_positive(e)) && det != 0.0;
}

// The hit of a ray with two triangles.
struct TrianglesHit {
    float t;      // In lengths of ray.d; the ray misses if it is not above 0.
    bool second;  // The ray hits the second one.
};

// Where a ray hits the triangles a b c and a c d: the nearer one if it hits both, the first if they are equally near.
TrianglesHit triangles_intersect(RayShear shear, ShearedVertex a, ShearedVertex b, ShearedVertex c, ShearedVertex d) {
    // For triangles that are small compared with their distance, the edge functions below are only rounding errors; so
    // test first whether the rectangle around their vertices holds the origin. Comparisons do not round.
    vec4 x = vec4(a.p.x, b.p.x, c.p.x, d.p.x);
    vec4 y = vec4(a.p.y, b.p.y, c.p.y, d.p.y);
    bool beside = all_positive(x) || all_negative(x) || all_positive(y) || all_negative(y);

    float diagonal = edge_function(c, a);
    vec3 e0 = vec3(edge_function(b, c), diagonal, edge_function(a, b));
    vec3 e1 = vec3(edge_function(c, d), edge_function(d, a), -diagonal);
    precise float det0 = e0.x + e0.y + e0.z;
    precise float det1 = e1.x + e1.y + e1.z;
    precise float t0 = shear.s.z * (e0.x * a.z + e0.y * b.z + e0.z * c.z) / det0;
    precise float t1 = shear.s.z * (e1.x * a.z + e1.y * c.z + e1.z * d.z) / det1;
    // The interpolated t lies between those of the vertices along z. But if the triangle is a sliver, rounding errors
    // of the edge functions may have moved the point off the ray; where the ray enters and leaves the box around both
    // triangles is certain, so t is clamped to that. Otherwise the box could be culled as further away than t.
    vec2 near = lesser(lesser(a.t, b.t), lesser(c.t, d.t));
    vec2 far = greater(greater(a.t, b.t), greater(c.t, d.t));
    float begin = greater(near.x, near.y);
    float end = lesser(far.x, far.y);
    t0 = lesser(greater(t0, begin), end);
    t1 = lesser(greater(t1, begin), end);
    bool meets0 = edges_meet(e0, det0) && t0 > 0.0;
    bool meets1 = edges_meet(e1, det1) && t1 > 0.0;
    bool second = meets1 && !(meets0 && t0 <= t1);
    float t = beside || !(meets0 || meets1) ? -1.0 : second ? t1 : t0;
    return TrianglesHit(t, second);
}

// The same for untransformed vertices.
TrianglesHit triangles_intersect(Ray ray, RayShear shear, vec3 a, vec3 b, vec3 c, vec3 d) {
    return triangles_intersect(shear, shear_vertex(ray, shear, a), shear_vertex(ray, shear, b),
                               shear_vertex(ray, shear, c), shear_vertex(ray, shear, d));
}

// Barycentric coordinates of the second and the third vertex of a triangle where the ray hits it.
vec2 triangle_coordinates(Ray ray, vec3 a, vec3 b, vec3 c) {
    RayShear shear = ray_shear(ray.d, reciprocals(ray.d));
    ShearedVertex va = shear_vertex(ray, shear, a);
    ShearedVertex vb = shear_vertex(ray, shear, b);
    ShearedVertex vc = shear_vertex(ray, shear, c);
    vec3 e = vec3(edge_function(vb, vc), edge_function(vc, va), edge_function(va, vb));
    precise float det = e.x + e.y + e.z;
    return e.yz / det;
}

#endif
