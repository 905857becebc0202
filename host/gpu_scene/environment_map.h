// Environment -> the records with which the device looks it up and samples it.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/light.h"

namespace candela {

struct EnvironmentMap {
    // Row-major from the top. pdf is luminance / irradiance: the density of texels chosen in proportion to
    // luminance times solid angle [1/sr], before the choice among lights.
    std::vector<EnvironmentTexel> texels;
    std::vector<AliasEntry> alias;  // Chooses a texel; empty for a black environment.
    double irradiance = 0.0;        // Luminance, integrated over the whole sphere [W/m^2].
    bool even = false;              // Radiance is the same in all directions.
};

EnvironmentMap build_environment_map(const Environment& environment);

}  // namespace candela
