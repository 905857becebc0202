// What the words of the kernels of first hits and first points say.
#pragma once

#include <algorithm>
#include <cassert>
#include <span>
#include <unordered_map>

#include "film/coverage.h"
#include "gpu_scene/gpu_scene.h"

namespace candela {

// Finds what a word says. Rays side by side mostly hit the same, so the last answer is kept.
class PartOfWord {
  public:
    explicit PartOfWord(const GpuScene& scene) : parts_(scene.shape_ids) {
        for (const InstancePlace& place : scene.instances)
            instances_.emplace(place.node, place.shape);
    }

    ShapePart operator()(uint32_t word) {
        if (word == 0) return NO_PART;
        if ((word & FIRST_HIT_INSTANCE) != 0) return of_node(word & ~FIRST_HIT_INSTANCE);
        return of_id(word - 1);
    }

  private:
    ShapePart of_node(uint32_t node) {
        if (node != node_) {
            node_ = node;
            of_node_ = {instances_.at(node), 0};
        }
        return of_node_;
    }

    ShapePart of_id(uint32_t id) {
        if (id >= begin_ && id < end_) return of_ids_;
        const auto after = std::ranges::upper_bound(parts_, id, {}, &ShapeIds::first);
        assert(after != parts_.begin());
        const ShapeIds& part = *(after - 1);
        begin_ = part.first;
        end_ = after == parts_.end() ? UINT32_MAX : after->first;
        return of_ids_ = {part.shape, part.group};
    }

    std::span<const ShapeIds> parts_;
    std::unordered_map<uint32_t, uint32_t> instances_;  // Shapes, by node.
    // The last answers: of a node, and of the ids from begin_ to before end_.
    uint32_t node_ = NO_INSTANCE, begin_ = 0, end_ = 0;
    ShapePart of_node_{}, of_ids_{};
};

}  // namespace candela
