// What fills the space between surfaces.
#pragma once

#include "base/math.h"

namespace candela {

// Beyond, floats do not tell the directions of Henyey and Greenstein's phase function apart.
inline constexpr float MAX_ANISOTROPY = 0.999f;

struct Medium {
    vec3 absorption{0};  // [1/m], each >= 0 (Beer and Lambert).
    vec3 scattering{0};  // [1/m], each >= 0.
    float g = 0.0f;      // Mean cosine of the angle by which light is scattered, within +-MAX_ANISOTROPY.

    bool operator==(const Medium&) const = default;
};

// The share of light that each particle of a medium scatters, with the mean cosine g, if the medium fills
// half of space and reflects that share of diffuse light; both in [0, 1]. Ref: Kulla and Conty 2017,
// Revisiting Physically Based Shading at Imageworks; OpenPBR 1.1, "Subsurface".
dvec3 single_scattering_albedo(dvec3 reflectance, float g);

// A medium in which light comes as far as `mean_free_path` [m], each above 0, before a particle scatters that
// share of it, and absorbs the rest.
Medium scattering_medium(dvec3 albedo, dvec3 mean_free_path, float g);

}  // namespace candela
