// Lights -> the arrays of their records, of the table that chooses one, and of their textures.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gpu_scene/area_lights.h"
#include "gpu_scene/environment_map.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/lamps.h"
#include "gpu_scene/light_tree_arrays.h"
#include "gpu_scene/material_arrays.h"
#include "gpu_scene/powered_lights.h"
#include "scene/scene.h"
#include "shared/light.h"

namespace candela {

struct LightFacts {
    uint32_t light_count = 0;     // Lamps, and their lights once, are among them.
    uint32_t lights_present = 0;  // The constant LIGHTS.
    LightGroups light_groups{};
    bool light_tree_pays = false;  // See light_sampler_rule.h.
};

struct LightArrays {
    LightFacts facts;
    std::vector<uvec4> lights, alias;
    LightTreeArrays tree;         // Empty if there is a single light, and the model is not small.
    uint32_t first_of_lamps = 0;  // The place of the lamps' lights in the table.
    bool sky_is_light = false;
};

// The lights of a scene.
struct SceneLights {
    const AreaLights& area;
    const Lamps& lamps;
    std::span<const PlacedLamp> placed;
    const PoweredLights& punctual;
    std::span<const LightBounds> bounds;  // Those of bounds_of_placed().
    const LightTree& tree;                // Over these.
    const std::optional<SkyLight>& sky;
    std::span<const vec3> places;  // Those of some_places().
};

// The sampler that a request means for these lights. A single light is not chosen, which is `power`.
LightSampler chosen_light_sampler(LightSampler requested, const LightFacts& lights);

// Joins the lights of a scene, in the order of LightGroups: those of surfaces are in front, then lamps. The
// sky is one of them if there is one and it helps to sample it. `box` is the box around all primitives.
// `of_small_model`: see MaterialFacts.
LightArrays build_light_arrays(const SceneLights& lights, const Box& box, bool of_small_model);

// The textures of lights, by their places in the table, with the places of their surfaces in leaf order;
// empty if no kernel reads them. `order` has the primitives of `flat` in leaf order; those of `trees` follow.
std::vector<uvec4> light_textures(const Scene& scene, const MaterialArrays& materials, const FlatScene& flat,
                                  const AreaLights& area, std::span<const uint32_t> order,
                                  const MeshTrees& trees, const Lamps& lamps, uint32_t first_of_lamps);

}  // namespace candela
