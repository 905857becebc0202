// A 4-wide bounding volume hierarchy over boxes: built with the surface area heuristic, quantised to 64 bytes
// a node, the same bytes for any number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/math.h"
#include "shared/bvh_node.h"

namespace candela {

// The most primitives of a leaf. A range this small never becomes a node. One primitive may be two triangles;
// of leaves with up to 1, 2 and 4 of those, 1 was the fastest on software Vulkan for the Cornell box and as
// fast as any for meshes, and traversal tests one primitive a turn.
inline constexpr uint32_t BVH_LEAF_SIZE = 1;

struct BvhOptions {
    unsigned threads = 0;  // 0: as many as the hardware has.
};

struct Bvh {
    // Node 0 is the root. Depth first: a node stands before its children, and child 0 with all below it
    // stands before child 1, so that a descent reads forwards and a subtree is one piece of memory. The
    // children of a node come first, its empty references last; no primitive at all is a root without
    // children.
    std::vector<PackedBvhNode> nodes;
    std::vector<uint32_t> order;  // Primitive indices; a leaf holds order[first .. first + count).
    Box bounds;                   // Exact, of all primitives; empty if there is none.
    uint32_t depth = 0;           // Nodes on the longest way down, the root included; at most BVH_STACK_SIZE.
    float sah_cost = 0.0f;  // Expected cost of a ray through `bounds`, in primitive tests; see measure.h.
};

// Builds a BVH over `boxes` [m]; flat boxes and points are welcome, as are none at all. Throws Error that
// names the index of the first box that is not finite, inverted or further than 1e37 from the origin, or if
// there are more than BVH_FIRST_MASK boxes.
Bvh build_bvh(std::span<const Box> boxes, const BvhOptions& options = {});

// The first broken invariant of `bvh` over `boxes`, in words; none if it is valid. Reads nothing out of
// range, whatever the references say.
std::optional<std::string> validate(const Bvh& bvh, std::span<const Box> boxes);

}  // namespace candela
