// Record of a medium, 1 word of uvec4: what lies between surfaces.
//
//   0: absorption.rgb, 0
#ifndef SHARED_MEDIUM_H
#define SHARED_MEDIUM_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint MEDIUM_WORDS = 1u;

const uint MEDIUM_NONE = 0u;         // Index of the medium that absorbs nothing, where camera rays begin.
const uint MEDIUM_SAME = 0xFFFFFFu;  // Behind a surface: the same medium as in front of it.

struct MediumRecord {
    vec3 absorption;  // For each unit of the frame, >= 0.
};

#ifdef __cplusplus

inline std::array<uvec4, MEDIUM_WORDS> pack(const MediumRecord& m) {
    return {word(m.absorption, 0u)};
}

}  // namespace candela
#else

MediumRecord medium_unpack(uvec4 a) {
    MediumRecord m;
    m.absorption = uintBitsToFloat(a.xyz);
    return m;
}

#endif

#endif
