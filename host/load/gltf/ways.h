// The ways of what moves in an animation.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "load/gltf/animation.h"
#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// Points that follow a node, while another one, which carries the mesh, is visible.
struct Cloud {
    uint32_t node = 0;
    uint32_t carrier = 0;
    std::vector<dvec3> points{};  // In the node's space.
};

// The least and the greatest weight of each morph target.
using WeightRanges = std::vector<std::pair<double, double>>;

// Adds the clouds of a primitive that is deformed, with `placement` from its space to the node's. A vertex of
// a skin lies between the places to which its joints alone would move it, so it is in the cloud of each.
void add_clouds(File& file, const Node& primitive, const WeightRanges& weights,
                const std::optional<Node>& skin, uint32_t carrier, std::vector<Cloud>& clouds);

// Times at which an animation is looked at: those of its keys, and up to 15 between each two; or, of more
// keys than `most`, evenly some of them. Empty if there is no channel.
std::vector<double> times_of(const Animation& animation, size_t most);

}  // namespace candela::gltf
