// Which way to choose among a scene's lights has the least noise in equal time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu_scene/flatten.h"
#include "gpu_scene/light_tree.h"
#include "gpu_scene/powered_lights.h"
#include "gpu_scene/scene_tree.h"

namespace candela {

// Points of surfaces that do not emit, all over the scene, in its frame: at most 64, and the centres of at
// most 64 instances.
std::vector<vec3> some_places(const FlatScene& flat, const SceneTree& tree);

// Whether the tree over `count` lights, those of lamps once, has less noise in equal time than the choice by
// power. `lights` are in the order of LightGroups, and their pmf is set; those with a place have the bounds
// `placed`. The integral of the sky's luminance is `sky_irradiance`.
bool light_tree_pays(uint32_t count, const PoweredLights& lights, std::span<const LightBounds> placed,
                     double sky_irradiance, std::span<const vec3> places);

}  // namespace candela
