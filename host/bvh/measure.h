// Depth and cost of a finished tree, computed from its nodes alone.
#pragma once

#include <cstdint>
#include <span>

#include "base/math.h"
#include "shared/bvh_node.h"

namespace candela {

// Half the surface area [m^2] in double precision, so that it does not overflow or underflow for any box that
// a BVH accepts.
inline double half_area(const Box& box) {
    const glm::dvec3 d = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Cost of a node in primitive tests: both records have the same size, and need about the same arithmetic.
inline constexpr double BVH_NODE_COST = 1.0;

struct BvhMeasures {
    uint32_t depth;
    float sah_cost;
};

// Measures the tree `nodes` with exact bounds `bounds`; every interior reference must point forwards.
//
// depth: nodes on the longest path down, including the root.
//
// sah_cost = (sum over nodes of A(node) * BVH_NODE_COST + sum over leaves of A(leaf)) / A(root), where A is
// the surface area of the decoded box, which is the box that rays hit (for the root, `bounds`); 0 if A(root)
// is 0. Ref: MacDonald and Booth 1990, Heuristics for Ray Tracing Using Space Subdivision.
BvhMeasures measure(std::span<const PackedBvhNode> nodes, const Box& bounds);

}  // namespace candela
