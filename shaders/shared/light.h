// Records of an area light, 4 words of uvec4, and of an entry of an alias table, 1 word.
//
//   Light                                   AliasEntry
//     0: p.xyz, kind                          0: threshold, alias, pmf, 0
//     1: e1.xyz, two_sided
//     2: e2.xyz, 0
//     3: radiance.rgb, pdf_area
#ifndef SHARED_LIGHT_H
#define SHARED_LIGHT_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint LIGHT_WORDS = 4u;
const uint ALIAS_WORDS = 1u;

const uint LIGHT_TRIANGLE = 0u;       // p + b1 e1 + b2 e2 with b1, b2 >= 0, b1 + b2 <= 1.
const uint LIGHT_PARALLELOGRAM = 1u;  // p + b1 e1 + b2 e2 with b1, b2 in [0, 1].

// A flat emitter; its front is the side that cross(e1, e2) points to. World space [m].
struct Light {
    uint kind;
    vec3 p;
    vec3 e1;
    vec3 e2;
    vec3 radiance;   // [W/(m^2 sr)], constant over the surface and its directions.
    uint two_sided;  // 1: emits from the back as well.
    float pdf_area;  // Density of light samples over this surface: pmf of the light / its area [1/m^2].
};

// Entry i of an alias table of n: column i is kept with probability threshold / 2^32, else the sample is
// `alias`.
struct AliasEntry {
    uint threshold;
    uint alias;
    float pmf;  // Probability of index i over the whole table.
};

#ifdef __cplusplus

inline std::array<uvec4, LIGHT_WORDS> pack(const Light& l) {
    return {words(l.p, l.kind), words(l.e1, l.two_sided), words(l.e2, 0u),
            words(l.radiance, floatBitsToUint(l.pdf_area))};
}

inline std::array<uvec4, ALIAS_WORDS> pack(const AliasEntry& e) {
    return {uvec4(e.threshold, e.alias, floatBitsToUint(e.pmf), 0u)};
}

}  // namespace candela
#else

Light light_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
    return Light(a.w, uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz),
                 uintBitsToFloat(d.xyz), b.w, uintBitsToFloat(d.w));
}

AliasEntry alias_unpack(uvec4 a) {
    return AliasEntry(a.x, a.y, uintBitsToFloat(a.z));
}

#endif

#endif
