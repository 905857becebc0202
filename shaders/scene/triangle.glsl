// Ray against triangle, watertight: two triangles that share an edge leave no gap between them.
//
// Ref: Woop, Benthin and Wald 2013, Watertight Ray/Primitive Intersection. Their double-precision fallback for edge
// functions of 0 is not needed for tightness: rounding is monotone, so that a computed edge function never has the
// wrong sign, it can only become 0; and 0 counts as inside on both sides of the edge.
#ifndef SCENE_TRIANGLE_GLSL
#define SCENE_TRIANGLE_GLSL

#include "base/ray.glsl"

// What a ray needs once for all triangles: the axis z along which it is longest, and the shear that turns it onto
// that axis.
struct RayShear {
    uint kz;
    vec3 s;
};

// v with its components turned so that component kz comes last, the order kept cyclic.
vec3 turn(vec3 v, uint kz) {
    return kz == 0u ? v.yzx : kz == 1u ? v.zxy : v;
}

RayShear ray_shear(vec3 d) {
    vec3 a = abs(d);
    uint kz = a.x > a.y ? (a.x > a.z ? 0u : 2u) : (a.y > a.z ? 1u : 2u);
    vec3 e = turn(d, kz);
    return RayShear(kz, vec3(e.x / e.z, e.y / e.z, 1.0 / e.z));
}

// Distance t > 0 in lengths of ray.d, and the barycentric coordinates of v1 and v2; t = -1 where the ray misses.
vec3 triangle_intersect(Ray ray, RayShear shear, vec3 v0, vec3 v1, vec3 v2) {
    vec3 a = turn(v0 - ray.o, shear.kz);
    vec3 b = turn(v1 - ray.o, shear.kz);
    vec3 c = turn(v2 - ray.o, shear.kz);
    precise vec2 pa = a.xy - shear.s.xy * a.z;
    precise vec2 pb = b.xy - shear.s.xy * b.z;
    precise vec2 pc = c.xy - shear.s.xy * c.z;
    // Far from a triangle that is small against its distance, the edge functions below are nothing but rounding errors;
    // so ask first whether the triangle's rectangle holds the origin. Comparisons do not round.
    if (any(greaterThan(min(pa, min(pb, pc)), vec2(0.0))) || any(lessThan(max(pa, max(pb, pc)), vec2(0.0)))) {
        return vec3(-1.0);
    }
    // Twice the signed areas that the origin of the sheared plane spans with each edge.
    precise float u = pc.x * pb.y - pc.y * pb.x;
    precise float v = pa.x * pc.y - pa.y * pc.x;
    precise float w = pb.x * pa.y - pb.y * pa.x;
    if (min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0) return vec3(-1.0);
    precise float det = u + v + w;
    if (det == 0.0) return vec3(-1.0);
    precise float t = shear.s.z * (u * a.z + v * b.z + w * c.z) / det;
    return vec3(t, v / det, w / det);
}

#endif
