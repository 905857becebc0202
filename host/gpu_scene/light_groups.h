// The order of lights in their table, and the tables for choosing one.
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/powered_lights.h"
#include "shared/light.h"

namespace candela {

// Sorts all lights into the order of LightGroups, and sets the probability of choosing each: its fraction of
// the total power. The lights of surfaces stay in front.
LightGroups group_lights(PoweredLights& lights);

// The alias tables of the groups, one after the other, for lights of these powers.
std::vector<AliasEntry> light_alias_tables(const LightGroups& groups, std::span<const double> powers);

}  // namespace candela
