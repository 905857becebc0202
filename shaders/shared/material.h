// Record of a material, 1 word of uvec4, and the tags of the BSDF models.
//
//   diffuse   0: MATERIAL_DIFFUSE, reflectance.rgb
#ifndef SHARED_MATERIAL_H
#define SHARED_MATERIAL_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint MATERIAL_WORDS = 1u;

const uint MATERIAL_DIFFUSE = 0u;

struct MaterialRecord {
    uint model;        // MATERIAL_*
    vec3 reflectance;  // Each in [0, 1].
};

#ifdef __cplusplus

inline std::array<uvec4, MATERIAL_WORDS> pack(const MaterialRecord& m) {
    return {uvec4(m.model, floatBitsToUint(m.reflectance.x), floatBitsToUint(m.reflectance.y),
                  floatBitsToUint(m.reflectance.z))};
}

}  // namespace candela
#else

MaterialRecord material_unpack(uvec4 a) {
    return MaterialRecord(a.x, uintBitsToFloat(a.yzw));
}

#endif

#endif
