// Record of a material, 2 words of uvec4, and the tags of the BSDF models.
//
//                          0: model | medium << 8, base.rgb            1: specular.rgb,   parameter
//   diffuse                  MATERIAL_DIFFUSE, reflectance               0                0
//   Phong                    MATERIAL_PHONG, kd                          ks               exponent n
//   mirror                   MATERIAL_MIRROR, reflectance                0                0
//   conductor                MATERIAL_CONDUCTOR, reflectance             0                alpha
//   dielectric               MATERIAL_DIELECTRIC_*, 0                    own_eta, 0, 0    eta
//   diffuse transmission     MATERIAL_DIFFUSE_TRANSMISSION, reflectance  transmittance    0
//   principled               MATERIAL_PRINCIPLED, base colour            record, some, 0  ior
//   unlit                    MATERIAL_UNLIT, radiance                    0                0
//   (a point in a medium)    MATERIAL_PHASE, albedo                      0                g
#ifndef SHARED_MATERIAL_H
#define SHARED_MATERIAL_H

#include "shared/medium.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint MATERIAL_WORDS = 2u;

const uint MATERIAL_DIFFUSE = 0u;
const uint MATERIAL_PHONG = 1u;
const uint MATERIAL_MIRROR = 2u;
const uint MATERIAL_CONDUCTOR = 3u;
const uint MATERIAL_DIELECTRIC_SCHLICK = 4u;
const uint MATERIAL_DIELECTRIC_EXACT = 5u;
const uint MATERIAL_DIFFUSE_TRANSMISSION = 6u;
const uint MATERIAL_PRINCIPLED = 7u;  // See shared/principled.h.
const uint MATERIAL_UNLIT = 8u;       // Shows its colour in any light, and scatters none.
const uint MATERIAL_PHASE = 9u;       // Of no material: see bsdf/phase.glsl.
const uint MATERIAL_COUNT = 10u;

// Limits of `parameter`.
const float MIN_FACET_ALPHA = 1e-3f;
const float GREATEST_EXPONENT = 1e5f;

struct MaterialRecord {
    uint model;       // MATERIAL_*
    uint medium;      // Behind the surface; 24 bits.
    vec3 base;        // Reflectance, each in [0, 1].
    vec3 specular;    // Phong's ks, or transmittance; each in [0, 1]. own_eta: 1 if eta holds whatever is in
                      // front. record: see shared/principled.h. some: 1 if some light passes the surface.
    float parameter;  // Phong's exponent; alpha; or eta, the index behind the surface over that in front.
};

#ifdef __cplusplus

inline std::array<uvec4, MATERIAL_WORDS> pack(const MaterialRecord& m) {
    const uvec4 base = word(m.base, m.model | m.medium << 8u);
    return {uvec4(base.w, base.x, base.y, base.z), word(m.specular, floatBitsToUint(m.parameter))};
}

}  // namespace candela
#else

MaterialRecord material_unpack(uvec4 a, uvec4 b) {
    MaterialRecord m;
    m.model = a.x & 255u;
    m.medium = a.x >> 8u;
    m.base = uintBitsToFloat(a.yzw);
    m.specular = uintBitsToFloat(b.xyz);
    m.parameter = uintBitsToFloat(b.w);
    return m;
}

#endif

#endif
