// See collapse.h.
#include "bvh/collapse.h"

#include <cassert>
#include <limits>

namespace candela {
namespace {

// The cost of at most k wide nodes or leaves in place of a node's two children, and how many of the k the
// left child gets.
struct Division {
    double cost = std::numeric_limits<double>::infinity();
    uint32_t left_fraction = 0;
};

Division best_division(const BinaryNode& left, const BinaryNode& right, uint32_t k) {
    Division best;
    // From the middle outwards: k / 2, k / 2 + 1, k / 2 - 1, k / 2 + 2 ...
    for (uint32_t i = 1; i < k; ++i) {
        const uint32_t fraction = i % 2 == 0 ? k / 2 + i / 2 : k / 2 - i / 2;
        const double cost = left.cost[fraction] + right.cost[k - fraction];
        if (cost < best.cost) best = {cost, fraction};
    }
    return best;
}

void add_children(std::span<const BinaryNode> tree, uint32_t index, uint32_t k, WideChildren& children) {
    const BinaryNode& node = tree[index];
    const uint32_t fraction = node.left_fraction[k];
    if (node.left == 0 || fraction == 0) {
        children.indices[children.count++] = index;
        return;
    }
    add_children(tree, node.left, fraction, children);
    add_children(tree, node.left + 1, k - fraction, children);
}

}  // namespace

void find_min_costs(std::span<BinaryNode> tree) {
    for (size_t i = tree.size(); i-- > 0;) {
        BinaryNode& node = tree[i];
        if (node.left == 0) continue;
        assert(node.left > i);
        const BinaryNode &left = tree[node.left], &right = tree[node.left + 1];
        const Division whole = best_division(left, right, BVH_WIDTH);
        node.cost[1] = node.area + whole.cost;
        node.left_fraction[BVH_WIDTH] = uint8_t(whole.left_fraction);
        for (uint32_t k = 2; k < BVH_WIDTH; ++k) {
            const Division open = best_division(left, right, k);
            const bool closed = node.cost[1] < open.cost;
            node.cost[k] = closed ? node.cost[1] : open.cost;
            node.left_fraction[k] = uint8_t(closed ? 0 : open.left_fraction);
        }
    }
}

WideChildren wide_children(std::span<const BinaryNode> tree, uint32_t index) {
    WideChildren children;
    add_children(tree, index, BVH_WIDTH, children);
    return children;
}

}  // namespace candela
