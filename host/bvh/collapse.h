// Turns a binary tree into one of BVH_WIDTH children a node, as cheaply for rays as can be.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "shared/bvh_node.h"

namespace candela {

// A node of a binary tree, which stands in an array before its children.
struct BinaryNode {
    double area = 0.0;  // Half its surface.
    uint32_t left = 0;  // Where its left child stands, and the right one behind it; 0: it is a leaf.

    // Filled by find_least_costs: there are many ways to have at most k nodes or leaves of the wide tree in
    // this one's place. Element k (1 and more) of `cost`: the least sum of the areas of wide nodes, theirs
    // and all below. Of `left_share`: how many of the k then stand for the left child; 0 if the node becomes
    // a wide one itself. A wide node has element BVH_WIDTH for children.
    std::array<double, BVH_WIDTH> cost{};
    std::array<uint8_t, BVH_WIDTH + 1> left_share{};
};

// Finds the wide tree with the least sum of areas of nodes, which is what its nodes cost a random ray; leaves
// cost the same in all. Among equals it takes the one with more children a node, evenly from both sides.
// Ref: Ylitie, Karras and Laine 2017, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs.
void find_least_costs(std::span<BinaryNode> tree);

// Indices of binary nodes.
struct WideChildren {
    std::array<uint32_t, BVH_WIDTH> indices{};
    uint32_t count = 0;
};

// What become the children of the wide node that stands for `index`, from left to right: leaves, and nodes
// that become wide ones. A leaf is its own only child. After find_least_costs.
WideChildren wide_children(std::span<const BinaryNode> tree, uint32_t index);

}  // namespace candela
