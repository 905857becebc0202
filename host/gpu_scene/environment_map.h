// Environment -> the records with which the device looks it up and samples it.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/constants.h"
#include "shared/light.h"

namespace candela {

// The sky as a light. Light samples look for the luminance above the sky's mean. BSDF samples find what is
// less bright well enough, behind a building that hides the sun, too; for an even sky there are no light
// samples. Ref: Karlik et al. 2019, MIS Compensation: Optimizing Sampling Techniques in Multiple Importance
// Sampling.
struct SkyLight {
    double irradiance = 0.0;  // What light samples look for, integrated over the whole sphere [W/m^2].
    dvec4 flux{0.0};          // As in LightGroups::sky_flux, in the map's own axes [W/m^2].
};

struct EnvironmentMap : SkyLight {
    bool even = false;  // The same radiance from everywhere.
    // Row-major from the top. pdf is the density [1/sr], before the choice among lights, of texels chosen in
    // proportion to luminance above the mean times solid angle, as whole numbers of random words allow.
    std::vector<EnvironmentTexel> texels;
    // For each row of texels a table that chooses a column, and at the end one that chooses a row; empty for
    // an even environment.
    std::vector<CdfEntry> cdf;
};

EnvironmentMap build_environment_map(const Environment& environment);

struct SkyFacts {
    uint32_t environment = ENVIRONMENT_NONE;
    bool even_sky = false;
    uvec2 environment_size{0};          // Texels.
    float environment_rotation = 0.0f;  // [rad]
};

struct SkyArrays {
    SkyFacts facts;
    std::vector<uvec4> texels, cdf;
};

// The arrays of an environment with that map; densities are 0 unless it is a light.
SkyArrays build_sky_arrays(const Environment& environment, EnvironmentMap map, bool is_light);

// A texel for kernels that may look up a sky, though the scene has none.
void add_dark_sky(SkyArrays& arrays);

}  // namespace candela
