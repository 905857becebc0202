// A 7-wide bounding volume hierarchy over boxes, one in a leaf: built with the surface area heuristic,
// quantised to 64 bytes a node, the same bytes for any number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/math.h"
#include "shared/bvh_node.h"

namespace candela {

struct BvhOptions {
    unsigned threads = 0;  // 0: as many as the hardware has.
};

struct Bvh {
    // Node 0 is the root. A node precedes its child nodes, which are adjacent; the descendants of the first
    // child precede those of the second. Without primitives, the root has one child, a leaf at position 0,
    // which does not exist.
    std::vector<PackedBvhNode> nodes;
    std::vector<uint32_t> order;  // Primitive indices; a leaf is a position.
    Box bounds;                   // Exact, of all primitives; empty if there is none.
    uint32_t depth = 0;     // Nodes on the longest path down, including the root; at most BVH_MAX_DEPTH.
    float sah_cost = 0.0f;  // Expected cost of a ray through `bounds`, in primitive tests; see measure.h.
};

// Builds a BVH over `boxes` [m]. Boxes may be flat or points, and there may be none. Throws Error that names
// the index of the first box that is not finite, is inverted, or lies further than 1e37 from the origin; and
// if there are more than BVH_MAX_PRIMITIVES boxes.
Bvh build_bvh(std::span<const Box> boxes, const BvhOptions& options = {});

// The first broken invariant of `bvh` over `boxes`, in words; nothing if it is valid. Never reads out of
// range, even if references are.
std::optional<std::string> validate(const Bvh& bvh, std::span<const Box> boxes);

}  // namespace candela
