// Record of a medium between surfaces, 2 words of uvec4.
//
//   0: absorption.rgb, ior    1: scattering.rgb, g
#ifndef SHARED_MEDIUM_H
#define SHARED_MEDIUM_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint MEDIUM_WORDS = 2u;

// Materials and paths know a medium by its index and, in the bits above, its priority.
const uint MEDIUM_NONE = 0u;  // Around everything: the scene's own, of priority 0.
const uint MEDIUM_INDEX_BITS = 12u;
const uint MEDIUM_BITS = 16u;
const uint MEDIUM_SAME = 0xFFFFFFu;  // Behind a surface: the same medium as in front of it.
const uint MAX_MEDIA = 1u << MEDIUM_INDEX_BITS;

// The most media at one point.
const uint MEDIA_AT_ONCE = 4u;

struct MediumRecord {
    vec3 absorption;  // For each unit of the frame, >= 0.
    float ior;        // Index of refraction, above 0.
    vec3 scattering;  // As absorption.
    float g;          // Mean cosine of the angle by which light is scattered, in (-1, 1).
};

#ifdef __cplusplus

inline std::array<uvec4, MEDIUM_WORDS> pack(const MediumRecord& m) {
    return {word(m.absorption, floatBitsToUint(m.ior)), word(m.scattering, floatBitsToUint(m.g))};
}

}  // namespace candela
#else

MediumRecord medium_unpack(uvec4 a, uvec4 b) {
    MediumRecord m;
    m.absorption = uintBitsToFloat(a.xyz);
    m.ior = uintBitsToFloat(a.w);
    m.scattering = uintBitsToFloat(b.xyz);
    m.g = uintBitsToFloat(b.w);
    return m;
}

#endif

#endif
