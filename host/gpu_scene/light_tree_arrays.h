// The tree over the lights of a scene, and the flux of those that are not in it.
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/light_tree.h"
#include "gpu_scene/powered_lights.h"
#include "shared/light.h"

namespace candela {

// The bounds of a light with a place in the scene; `power` is its power over pi [W].
LightBounds bounds_of(const LightRecord& light, double power);

// The tree over the lights that have a place in the scene, which are all but the directional ones. Its lights
// have the indices that they have in the table of lights.
LightTree build_light_tree(const PoweredLights& area, const PoweredLights& punctual);

struct LightTreeArrays {
    std::vector<uvec4> nodes, trails;
};

LightTreeArrays pack_light_tree(const LightTree& tree);

// Sets the fluxes of the groups; `lights` is the table of lights.
void set_fluxes(LightGroups& groups, std::span<const LightRecord> lights, const dvec4& sky_flux,
                const LightTree& tree);

// The groups with the sky turned about +Y by that angle [rad].
LightGroups turned(LightGroups groups, float sky_rotation);

}  // namespace candela
