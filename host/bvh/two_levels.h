// Trees below a tree: instances, each with the tree of its mesh as its only child.
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/bvh.h"

namespace candela {

// A tree over primitives and instances in one array of nodes. The record of an instance has a node's place
// beside the nodes that are its siblings; what it says is left to the caller. Trees of meshes may follow. The
// children that are nodes lie in the order of bvh_longest_axis().
struct TwoLevelTree {
    std::vector<PackedBvhNode> nodes;
    std::vector<uint32_t> order;            // Primitives in leaf order.
    std::vector<uint32_t> instance_nodes;   // The place of each instance among the nodes,
    std::vector<uint32_t> instance_levels;  // and its level: the root has level 1.
    uint32_t depth = 0;  // Nodes on the longest way down to a primitive, or to an instance and its record.
};

// Makes nodes of the leaves of `tree` that are instances: the boxes that it was built over are those of
// `primitive_count` primitives, and then those of instances. There is at least one instance.
TwoLevelTree separate_instances(const Bvh& tree, uint32_t primitive_count);

// Appends the tree of a mesh, with its nodes' children in that order, whose primitives follow the
// `primitives` that there are before. Returns the place of its root. Throws Error if the nodes or primitives
// are more than a tree may have.
uint32_t append_tree(std::vector<PackedBvhNode>& nodes, uint64_t primitives, const Bvh& tree);

}  // namespace candela
