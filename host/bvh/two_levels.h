// Trees below a tree: instances, each with the tree of its mesh as its only child.
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/bvh.h"

namespace candela {

// A tree over primitives and instances in one array of nodes. The record of an instance has the place of a
// node beside its sibling nodes; the caller fills it in. Trees of meshes may follow. The children that are
// nodes are sorted along bvh_longest_axis().
struct TwoLevelTree {
    std::vector<PackedBvhNode> nodes;
    std::vector<uint32_t> order;            // Primitives in leaf order.
    std::vector<uint32_t> instance_nodes;   // The place of each instance among the nodes.
    std::vector<uint32_t> instance_levels;  // The level of each instance; the root has level 1.
    uint32_t depth = 0;  // Nodes on the longest path down to a primitive, or to an instance and its record.
};

// Makes nodes of the leaves of `tree` that are instances: it was built over the boxes of `primitive_count`
// primitives, followed by those of instances, of which there is at least one.
TwoLevelTree separate_instances(const Bvh& tree, uint32_t primitive_count);

// Sorts the children of a tree's nodes that are nodes in the same way.
void sort_children(Bvh& tree);

// Appends the tree of a mesh, whose children are sorted; its primitives follow the existing `primitives`.
// Returns the place of its root. Throws Error if a tree cannot have so many nodes or primitives.
uint32_t append_tree(std::vector<PackedBvhNode>& nodes, uint64_t primitives, const Bvh& tree);

}  // namespace candela
