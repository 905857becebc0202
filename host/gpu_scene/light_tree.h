// A tree over lights, by which a light is chosen for a lit point: shaders/light/tree.glsl.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "shared/light_tree.h"

namespace candela {

// Bounds of a light.
struct LightBounds {
    Box box;                 // In the frame of the scene.
    vec3 axis{0, 0, 1};      // Unit length.
    float normals = 0.0f;    // Maximum angle between a normal of the light and the axis [rad], at most pi.
    float emission = 0.0f;   // Maximum angle between emitted light and its normal [rad], at most pi / 2.
    bool two_sided = false;  // It emits in the opposite directions, too.
    double strength = 0.0;   // Maximum intensity [W/sr], > 0.
};

using LightTreeNode = std::array<LightTreeChild, LIGHT_TREE_WIDTH>;

struct LightTree {
    std::vector<LightTreeNode> nodes;  // The root first, parents before children; empty without lights.
    std::vector<uint32_t> trails;      // The way down to each light; see LIGHT_TREE_MAX_DEPTH.
    double strength = 0.0;             // Sum over all lights.
};

// Builds a tree over `lights`, with the same bits for any number of threads; 0 uses all hardware threads.
// Ref: Conty Estevez and Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree
// Splitting, section 4.
LightTree build_light_tree(std::span<const LightBounds> lights, unsigned threads = 0);

}  // namespace candela
