// Which way to choose among a scene's lights has the least noise in equal time.
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/flatten.h"
#include "gpu_scene/powered_lights.h"
#include "gpu_scene/scene_tree.h"

namespace candela {

// Points of surfaces that do not emit, all over the scene, in its frame: at most 64, and the centres of at
// most 64 instances.
std::vector<vec3> some_places(const FlatScene& flat, const SceneTree& tree);

// Whether the tree over lights has less noise in equal time than the choice by power. `lights` are in the
// order of LightGroups, and their pmf is set; the integral of the sky's luminance is `sky_irradiance`.
bool light_tree_pays(const PoweredLights& lights, double sky_irradiance, std::span<const vec3> places);

}  // namespace candela
