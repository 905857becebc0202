// A tree over lights, from which a light is chosen for a point that is lit: shaders/light/tree.glsl.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "shared/light_tree.h"

namespace candela {

// What the tree knows of a light.
struct LightBounds {
    Box box;                 // Around it, in the frame of the scene.
    vec3 axis{0, 0, 1};      // Unit length. All its normals are
    float normals = 0.0f;    // within this angle around the axis [rad], at most pi,
    float emission = 0.0f;   // and what it emits is within this angle around a normal [rad], at most pi / 2.
    bool two_sided = false;  // The same on the other side.
    double strength = 0.0;   // Its greatest intensity [W/sr], > 0.
};

using LightTreeNode = std::array<LightTreeChild, LIGHT_TREE_WIDTH>;

struct LightTree {
    std::vector<LightTreeNode> nodes;  // The root first, each before its children; none without lights.
    std::vector<uint32_t> trails;      // Of each light: the way down to it; see LIGHT_TREE_MAX_DEPTH.
    double strength = 0.0;             // Of all lights together.
};

// Builds a tree over `lights`: whatever the number of threads, the same bits. 0 threads: as many as the
// hardware has. Ref: Conty Estevez and Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree
// Splitting, section 4.
LightTree build_light_tree(std::span<const LightBounds> lights, unsigned threads = 0);

}  // namespace candela
