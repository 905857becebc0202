// Record of a primitive, what the BVH's leaves hold, and of its shading normals. The only functions are
// `pack` (C++) and `unpack` (GLSL), side by side.
//
//   Primitive, 3 words of uvec4         Normals, 1 word
//     0: a.xyz, id                        0: n0, n1, n2 (octahedral, 2 x 16 bits), smooth
//     1: b.xyz, material | kind << 30
//     2: c.xyz, light
#ifndef SHARED_PRIMITIVE_H
#define SHARED_PRIMITIVE_H

#include "shared/constants.h"

#ifdef __cplusplus
#include <array>
#include <cmath>
namespace candela {
#endif

const uint PRIMITIVE_WORDS = 3u;
const uint NORMALS_WORDS = 1u;

// Kinds of primitives. World space [m].
const uint PRIMITIVE_TRIANGLE = 0u;  // Vertices a, b, c; counter-clockwise from the front.
const uint PRIMITIVE_SPHERE = 1u;    // Centre a, radius b.x; the front is outside.
const uint PRIMITIVE_DISK = 2u;      // a + x b + y c with x^2 + y^2 <= 1; cross(b, c) points to the front.
const uint PRIMITIVE_KIND_SHIFT = 30u;

struct Primitive {
    uint kind;  // PRIMITIVE_*
    vec3 a;
    vec3 b;
    vec3 c;
    uint id;        // Position in the scene's own order; the lesser one wins where two hits are equally near.
    uint material;  // Index of a material record, below 2^30.
    uint light;     // Index of a light record, or NO_LIGHT.
};

#ifdef __cplusplus

inline std::array<uvec4, PRIMITIVE_WORDS> pack(const Primitive& p) {
    return {words(p.a, p.id), words(p.b, p.material | p.kind << PRIMITIVE_KIND_SHIFT), words(p.c, p.light)};
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

// Shading normals at the three vertices, unit length, world space. A flat primitive has a record of zeros.
inline std::array<uvec4, NORMALS_WORDS> pack_normals(vec3 n0, vec3 n1, vec3 n2) {
    return {uvec4(pack_octahedral(n0), pack_octahedral(n1), pack_octahedral(n2), 1u)};
}

}  // namespace candela
#else

Primitive primitive_unpack(uvec4 u, uvec4 v, uvec4 w) {
    return Primitive(v.w >> PRIMITIVE_KIND_SHIFT, uintBitsToFloat(u.xyz), uintBitsToFloat(v.xyz),
                     uintBitsToFloat(w.xyz), u.w, v.w & ((1u << PRIMITIVE_KIND_SHIFT) - 1u), w.w);
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
