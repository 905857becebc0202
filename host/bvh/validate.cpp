// Checks every promise that bvh.h and bvh_node.h make about a tree. See bvh.h.
#include "bvh/bvh.h"
#include "bvh/measure.h"

namespace candela {

namespace {

using Problem = std::optional<std::string>;

std::string name(const char* what, size_t index) {
    return std::string(what) + " " + std::to_string(index);
}

bool contains(const Box& outer, const Box& inner) {
    return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) &&
           glm::all(glm::lessThanEqual(inner.hi, outer.hi));
}

// Every index of `count` primitives is in `order` once.
Problem check_order(std::span<const uint32_t> order, size_t count) {
    if (order.size() != count) {
        return "order has " + name("entries", order.size()) + " for " + name("primitives", count);
    }
    std::vector<bool> seen(count);
    for (const uint32_t primitive : order) {
        if (primitive >= count)
            return name("order names primitive", primitive) + " of " + std::to_string(count);
        if (seen[primitive]) return name("order names primitive", primitive) + " twice";
        seen[primitive] = true;
    }
    return std::nullopt;
}

// The nodes and positions claimed by a tree's references so far.
struct Claims {
    std::vector<bool> nodes;
    std::vector<bool> positions;

    // Claims the node or position of child `reference` of node `parent`.
    Problem claim(size_t parent, uint32_t reference) {
        if (!is_leaf(reference)) {
            if (reference >= nodes.size())
                return name("reference to node", reference) + ", which is out of range";
            if (reference <= parent) return name("reference back to node", reference);
            if (nodes[reference]) return name("second reference to node", reference);
            nodes[reference] = true;
            return std::nullopt;
        }
        const uint32_t position = leaf_position(reference);
        if (position >= positions.size())
            return name("leaf with position", position) + ", which is out of range";
        if (positions[position]) return name("second leaf with position", position);
        positions[position] = true;
        return std::nullopt;
    }
};

// References are in range and forwards; every node but the root and every position is referred to once.
Problem check_references(const Bvh& bvh) {
    Claims claims{std::vector<bool>(bvh.nodes.size()), std::vector<bool>(bvh.order.size())};
    for (size_t i = 0; i < bvh.nodes.size(); ++i) {
        const BvhNode node = unpack(bvh.nodes[i]);
        for (uint32_t c = 0; c < bvh_child_count(node); ++c) {
            if (const Problem problem = claims.claim(i, bvh_child(node.children, c)))
                return name("node", i) + ": " + *problem;
        }
    }
    for (size_t i = 1; i < claims.nodes.size(); ++i) {
        if (!claims.nodes[i]) return name("node", i) + ": no reference to it";
    }
    for (size_t i = 0; i < claims.positions.size(); ++i) {
        if (!claims.positions[i]) return name("position", i) + " of order: in no leaf";
    }
    return std::nullopt;
}

// Every decoded child box contains the boxes of all primitives below it, and `bounds` is exact. (It need not
// contain the decoded boxes below it: those are rounded outwards in a grid of their own.)
Problem check_boxes(const Bvh& bvh, std::span<const Box> boxes) {
    std::vector<Box> exact(bvh.nodes.size());
    for (size_t i = bvh.nodes.size(); i-- > 0;) {
        const BvhNode node = unpack(bvh.nodes[i]);
        for (uint32_t c = 0; c < bvh_child_count(node); ++c) {
            const uint32_t reference = bvh_child(node.children, c);
            const Box below =
                is_leaf(reference) ? boxes[bvh.order[leaf_position(reference)]] : exact[reference];
            if (!contains(child_box(node, c), below)) {
                return name("node", i) + ": the box of " + name("child", c) +
                       " does not contain what is below it";
            }
            exact[i].extend(below);
        }
    }
    if (exact[0].lo != bvh.bounds.lo || exact[0].hi != bvh.bounds.hi)
        return "bounds are not those of the primitives";
    return std::nullopt;
}

Problem check_measures(const Bvh& bvh) {
    const BvhMeasures actual = measure(bvh.nodes, bvh.bounds);
    if (bvh.depth != actual.depth)
        return name("depth is", actual.depth) + ", not " + std::to_string(bvh.depth);
    if (bvh.depth > BVH_MAX_DEPTH) {
        return name("depth is", bvh.depth) + ", more than " + name("BVH_MAX_DEPTH,", BVH_MAX_DEPTH);
    }
    if (bvh.sah_cost != actual.sah_cost) return "sah_cost is not that of the nodes";
    return std::nullopt;
}

}  // namespace

std::optional<std::string> validate(const Bvh& bvh, std::span<const Box> boxes) {
    if (bvh.nodes.empty()) return "there is no root";
    Problem problem = check_order(bvh.order, boxes.size());
    if (!problem && !boxes.empty()) problem = check_references(bvh);
    if (!problem && !boxes.empty()) problem = check_boxes(bvh, boxes);
    if (!problem) problem = check_measures(bvh);
    return problem;
}

}  // namespace candela
