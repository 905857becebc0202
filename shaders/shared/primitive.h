// Records of a primitive, the content of the BVH's leaves: its geometry, which traversal reads; its surface,
// which is read when a path hits it; and its shading normals. The only functions are `pack` (C++) and
// `unpack` (GLSL), side by side.
//
//   Primitive, 3 words of uvec4   Surface, 1 word                   Normals, 1 word
//     0: a.xyz, d.x or tag          0: id, id of the second           0: at a, b, c, d
//     1: b.xyz, d.y                    triangle, material |              (octahedral, 2 x 16 bits)
//     2: c.xyz, d.z                    passable << 22 |
//                                      error | smooth << 31,
//                                      light
#ifndef SHARED_PRIMITIVE_H
#define SHARED_PRIMITIVE_H

#include "shared/constants.h"

#ifdef __cplusplus
#include <array>
#include <cmath>
namespace candela {
#endif

const uint PRIMITIVE_WORDS = 3u;
const uint SURFACE_WORDS = 1u;
const uint NORMALS_WORDS = 1u;

// Kinds of primitives. In the frame of the scene.
//
// Two triangles that share an edge, as most in a mesh do, form one primitive: this halves memory and leaves,
// and is cheaper than testing each. A single triangle has a second one, a c d, without area.
const uint PRIMITIVE_TRIANGLES = 0u;  // a b c and a c d; counter-clockwise from the front.
const uint PRIMITIVE_SPHERE = 1u;     // Centre a, radius b.x; the front is outside.
const uint PRIMITIVE_DISK = 2u;       // a + x b + y c with x^2 + y^2 <= 1; cross(b, c) points to the front.

// The tag of a kind without d: a NaN, which no vertex has.
const uint PRIMITIVE_TAG = 0x7FC00000u;

const uint SURFACE_SMOOTH_BIT = 0x80000000u;
const uint SURFACE_ERROR_BITS = 0x7F800000u;  // The exponent of a float.
const uint SURFACE_OPACITY_BIT = 0x00400000u;
const uint MAX_MATERIALS = 0x00400000u;

struct Primitive {
    uint kind;  // PRIMITIVE_*
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 d;  // Only for triangles; equal to c if there is only one.
};

struct Surface {
    uvec2 id;          // Position in the scene's own order, of each triangle.
    uint material;     // Index of a material record, below MAX_MATERIALS.
    uint has_normals;  // 1: has shading normals.
    uint light;        // Index of a light record, of a mesh's surface among those of its lamps; or NO_LIGHT.
    float error;       // Distance at which rays must begin, along its normal: 0 or a power of two.
    uint passable;     // 1: some rays may pass it, by scene/opacity.glsl.
};

#ifdef __cplusplus

inline std::array<uvec4, PRIMITIVE_WORDS> pack(const Primitive& p) {
    const uint first = p.kind == PRIMITIVE_TRIANGLES ? floatBitsToUint(p.d.x) : PRIMITIVE_TAG | p.kind;
    return {word(p.a, first), word(p.b, floatBitsToUint(p.d.y)), word(p.c, floatBitsToUint(p.d.z))};
}

inline std::array<uvec4, SURFACE_WORDS> pack(const Surface& s) {
    const uint bits = s.has_normals * SURFACE_SMOOTH_BIT | s.passable * SURFACE_OPACITY_BIT;
    return {uvec4(s.id.x, s.id.y, s.material | floatBitsToUint(s.error) | bits, s.light)};
}

// Octahedral map of a unit vector to 2 x 16 signed bits. Ref: Cigolle et al. 2014, A Survey of Efficient
// Representations for Independent Unit Vectors, section 3.2.
inline uint pack_octahedral(vec3 n) {
    const float l1 = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
    vec2 e = vec2(n.x, n.y) / l1;
    if (n.z < 0.0f) {
        e = vec2((1.0f - std::fabs(e.y)) * std::copysign(1.0f, e.x),
                 (1.0f - std::fabs(e.x)) * std::copysign(1.0f, e.y));
    }
    const auto snorm16 = [](float x) { return uint(int(std::lround(x * 32767.0f))) & 0xFFFFu; };
    return snorm16(e.x) | snorm16(e.y) << 16;
}

// Shading normals at the vertices a, b, c, d, unit length, world space. A flat primitive has a record of
// zeros.
inline std::array<uvec4, NORMALS_WORDS> pack_normals(vec3 a, vec3 b, vec3 c, vec3 d) {
    return {uvec4(pack_octahedral(a), pack_octahedral(b), pack_octahedral(c), pack_octahedral(d))};
}

}  // namespace candela
#else

Primitive primitive_unpack(uvec4 u, uvec4 v, uvec4 w) {
    Primitive p;
    p.kind = (u.w & ~3u) == PRIMITIVE_TAG ? u.w & 3u : PRIMITIVE_TRIANGLES;
    p.a = uintBitsToFloat(u.xyz);
    p.b = uintBitsToFloat(v.xyz);
    p.c = uintBitsToFloat(w.xyz);
    p.d = uintBitsToFloat(uvec3(u.w, v.w, w.w));
    return p;
}

Surface surface_unpack(uvec4 u) {
    Surface s;
    s.id = u.xy;
    s.material = u.z & MAX_MATERIALS - 1u;
    s.error = uintBitsToFloat(u.z & SURFACE_ERROR_BITS);
    s.has_normals = u.z / SURFACE_SMOOTH_BIT;
    s.passable = u.z / SURFACE_OPACITY_BIT & 1u;
    s.light = u.w;
    return s;
}

// Inverse of pack_octahedral; unit length.
vec3 octahedral_unpack(uint bits) {
    vec2 e = max(vec2(int(bits << 16) >> 16, int(bits) >> 16) / 32767.0, vec2(-1.0));
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return normalize(n);
}

#endif

#endif
