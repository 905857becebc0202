// The tree over the lights of a scene, and the flux of those that are not in it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu_scene/lamps.h"
#include "gpu_scene/light_tree.h"
#include "gpu_scene/powered_lights.h"
#include "shared/light.h"

namespace candela {

// The bounds of a light with a place in the scene; `power` is its power over pi [W].
LightBounds bounds_of(const LightRecord& light, double power);

// The bounds of the lights that have a place in the scene, which are all but the directional ones, and of
// lamps, in the order of the table of lights.
std::vector<LightBounds> bounds_of_placed(const PoweredLights& area, std::span<const PlacedLamp> lamps,
                                          const PoweredLights& punctual);

struct LightTreeArrays {
    std::vector<uvec4> nodes, trails;
};

// The tree, and then those of lamps, whose lights are in the table of lights from `first` on; their leaves
// say which of the lamp's lights they are.
LightTreeArrays pack_light_trees(const LightTree& tree, const Lamps& lamps = {}, uint32_t first = 0);

// Sets the fluxes of the groups; `lights` is the table of lights.
void set_fluxes(LightGroups& groups, std::span<const LightRecord> lights, const dvec4& sky_flux,
                const LightTree& tree);

// The groups with the sky turned about +Y by that angle [rad].
LightGroups turned(LightGroups groups, float sky_rotation);

}  // namespace candela
