// See two_levels.h.
#include "bvh/two_levels.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <string>

#include "base/error.h"

namespace candela {
namespace {

// The children of a node: nodes and instances, then primitives.
struct Regrouped {
    std::array<uint32_t, BVH_WIDTH> before{};  // The index of each in the old node.
    uint32_t nodes = 0;                        // Number of nodes and instances.
    uint32_t count = 0;
};

// The children of a node of that many nodes and children in all, in their order.
Regrouped children_of(uint32_t nodes, uint32_t count) {
    Regrouped children{.nodes = nodes, .count = count};
    std::iota(children.before.begin(), children.before.end(), 0u);
    return children;
}

// Sorts the children that are nodes along bvh_longest_axis().
void sort_nodes(const BvhNode& node, Regrouped& children) {
    const auto axis = glm::length_t(bvh_longest_axis(node.scale));
    const auto middle = [&](uint32_t child) {
        const Box box = child_box(node, child);
        return box.lo[axis] + box.hi[axis];
    };
    std::ranges::stable_sort(std::span(children.before).first(children.nodes), {}, middle);
}

// `node` with its boxes in the order of `children`.
BvhNode reordered(const BvhNode& node, const Regrouped& children) {
    BvhNode result = node;
    for (uint32_t half = 0; half < 2; ++half)
        result.q_lo[half] = result.q_hi[half] = uvec3(0);
    for (uint32_t i = 0; i < children.count; ++i) {
        const uint32_t from = children.before[i];
        const auto byte = [&](const uvec3& q) { return (q >> (8 * (from % 4)) & 0xFFu) << (8 * (i % 4)); };
        result.q_lo[i / 4] |= byte(node.q_lo[from / 4]);
        result.q_hi[i / 4] |= byte(node.q_hi[from / 4]);
    }
    return result;
}

}  // namespace

TwoLevelTree separate_instances(const Bvh& tree, uint32_t primitive_count) {
    TwoLevelTree result;
    const size_t instances = tree.order.size() - primitive_count;
    result.nodes.reserve(tree.nodes.size() + instances);
    result.order.reserve(primitive_count);
    result.instance_nodes.resize(instances);
    result.instance_levels.resize(instances);
    struct Pending {
        uint32_t from;
        uint32_t to;
        uint32_t level;
    };
    result.nodes.resize(1);
    std::vector<Pending> stack{{0, 0, 1}};
    while (!stack.empty()) {
        const Pending next = stack.back();
        stack.pop_back();
        result.depth = std::max(result.depth, next.level);
        BvhNode node = unpack(tree.nodes[next.from]);
        Regrouped children = children_of(bvh_node_count(node.children), bvh_child_count(node));
        const auto box_of = [&](uint32_t child) {
            return tree.order[leaf_position(bvh_child(node.children, child))];
        };
        const auto is_node = [old = children.nodes](uint32_t child) { return child < old; };
        const auto begin = children.before.begin();
        const auto primitives = std::stable_partition(begin, begin + children.count, [&](uint32_t child) {
            return is_node(child) || box_of(child) >= primitive_count;
        });
        children.nodes = uint32_t(primitives - begin);
        sort_nodes(node, children);

        const auto first = uint32_t(result.nodes.size());
        const auto first_primitive = uint32_t(result.order.size());
        result.nodes.resize(first + children.nodes);
        for (uint32_t i = children.nodes; i-- > 0;) {
            const uint32_t child = children.before[i];
            if (is_node(child)) {
                stack.push_back({node.children.x + child, first + i, next.level + 1});
                continue;
            }
            const uint32_t instance = box_of(child) - primitive_count;
            result.instance_nodes[instance] = first + i;
            result.instance_levels[instance] = next.level + 1;
            result.depth = std::max(result.depth, next.level + 1);
        }
        for (uint32_t i = children.nodes; i < children.count; ++i)
            result.order.push_back(box_of(children.before[i]));
        node = reordered(node, children);
        node.children = bvh_children(children.nodes, first, children.count, first_primitive);
        result.nodes[next.to] = pack(node);
    }
    return result;
}

void sort_children(Bvh& tree) {
    // Children follow their parents.
    for (PackedBvhNode& packed : tree.nodes) {
        const BvhNode node = unpack(packed);
        Regrouped children = children_of(bvh_node_count(node.children), bvh_child_count(node));
        sort_nodes(node, children);
        const std::span group = std::span(tree.nodes).subspan(node.children.x, children.nodes);
        std::array<PackedBvhNode, BVH_WIDTH> before;
        std::ranges::copy(group, before.begin());
        for (uint32_t c = 0; c < children.nodes; ++c)
            group[c] = before[children.before[c]];
        packed = pack(reordered(node, children));
    }
}

uint32_t append_tree(std::vector<PackedBvhNode>& nodes, uint64_t primitives, const Bvh& tree) {
    const uint64_t sum = nodes.size() + tree.nodes.size();
    const auto too_many = [](const char* what, uint64_t count, uint64_t limit) {
        throw Error("BVH: the meshes have " + std::to_string(count) + " " + what + ", but at most " +
                    std::to_string(limit) + " can be addressed; simplify the meshes");
    };
    if (sum >= BVH_MAX_NODES) too_many("nodes", sum, BVH_MAX_NODES - 1);
    if (primitives + tree.order.size() > BVH_MAX_PRIMITIVES)
        too_many("primitives", primitives + tree.order.size(), BVH_MAX_PRIMITIVES);
    const auto root = uint32_t(nodes.size());
    for (const PackedBvhNode& packed : tree.nodes) {
        BvhNode node = unpack(packed);
        node.children += uvec2(root, uint32_t(primitives));
        nodes.push_back(pack(node));
    }
    return root;
}

}  // namespace candela
