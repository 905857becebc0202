// Animations of a glTF file, which pose nodes at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "load/gltf/pose.h"

namespace candela::gltf {

enum class Interpolation { step, linear, cubic };

// The values of a channel at its keys, which lie in the file's contents.
struct Sampler {
    std::span<const float> times;  // [s], ascending.
    std::span<const float>
        values;  // `width` numbers per key; of a cubic spline, in-tangent, value, out-tangent.
    size_t width = 0;
    Interpolation interpolation = Interpolation::linear;

    const float* value(size_t key) const {
        return &values[interpolation == Interpolation::cubic ? (3 * key + 1) * width : key * width];
    }
    const float* in_tangent(size_t key) const { return &values[3 * key * width]; }
    const float* out_tangent(size_t key) const { return &values[(3 * key + 2) * width]; }
};

// What a channel animates of a node.
enum class Path { translation, rotation, scale, weights, visible };

struct Channel {
    uint32_t node = 0;
    Path path = Path::translation;
    Sampler sampler;
};

class Animation {
  public:
    // Reads the animation of that name or index, all animations ("all"), or, if no name is given, the first.
    // Of pointers (KHR_animation_pointer), those to the visibility of nodes are read. Throws Error (usage)
    // for an animation that the file lacks.
    Animation(File& file, const std::optional<std::string>& name, const std::vector<PosedNode>& nodes);

    // Poses the nodes, which are as in the file, at `time` [s]. An animation is constant before its first key
    // and after its last one.
    void pose(double time, std::vector<PosedNode>& nodes) const;

    const std::vector<Channel>& channels() const { return channels_; }

  private:
    void read_channel(File& file, const Node& animation, const Node& channel,
                      const std::vector<PosedNode>& nodes);

    std::vector<Channel> channels_;
};

}  // namespace candela::gltf
