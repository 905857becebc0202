// Turns a binary tree into one with up to BVH_WIDTH children per node, at the least cost for rays.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "shared/bvh_node.h"

namespace candela {

// A node of a binary tree, which precedes its children in an array.
struct BinaryNode {
    double area = 0.0;  // Half its surface.
    uint32_t left = 0;  // Index of its left child, which the right one follows; 0: it is a leaf.

    // Filled by find_min_costs. There are many ways to replace this node by at most k nodes or leaves of
    // the wide tree. cost[k], k >= 1: the least sum of the areas of these and all wide nodes below them.
    // left_fraction[k]: how many of the k then replace the left child; 0 if this node becomes a wide one
    // itself. The children of a wide node follow from left_fraction[BVH_WIDTH].
    std::array<double, BVH_WIDTH> cost{};
    std::array<uint8_t, BVH_WIDTH + 1> left_fraction{};
};

// Finds the wide tree with the least sum of areas of nodes, which is the cost of its nodes for a random ray;
// leaves cost the same in every tree. Among equal trees it prefers more children per node, evenly from both
// sides.
// Ref: Ylitie, Karras and Laine 2017, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs.
void find_min_costs(std::span<BinaryNode> tree);

// Indices of binary nodes.
struct WideChildren {
    std::array<uint32_t, BVH_WIDTH> indices{};
    uint32_t count = 0;
};

// The children of the wide node that replaces `index`, from left to right: leaves, and nodes that become wide
// ones. A leaf is its own only child. For use after find_min_costs.
WideChildren wide_children(std::span<const BinaryNode> tree, uint32_t index);

}  // namespace candela
