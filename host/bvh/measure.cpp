// See measure.h.
#include "bvh/measure.h"

#include <algorithm>
#include <vector>

namespace candela {

BvhMeasures measure(std::span<const PackedBvhNode> nodes, const Box& bounds) {
    std::vector<uint32_t> depths(nodes.size());  // Depth of each node's subtree, including itself.
    const double root_area = bounds.is_empty() ? 0.0 : half_area(bounds);
    double cost = root_area * BVH_NODE_COST;
    for (size_t i = nodes.size(); i-- > 0;) {  // Children follow their parent.
        const BvhNode node = unpack(nodes[i]);
        uint32_t deepest = 0;
        for (uint32_t c = 0; c < bvh_child_count(node); ++c) {
            const uint32_t reference = bvh_child(node.children, c);
            cost += half_area(child_box(node, c)) * (is_leaf(reference) ? 1.0 : BVH_NODE_COST);
            if (!is_leaf(reference)) deepest = std::max(deepest, depths[reference]);
        }
        depths[i] = deepest + 1;
    }
    return {depths[0], root_area > 0.0 ? float(cost / root_area) : 0.0f};
}

}  // namespace candela
