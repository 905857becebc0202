// Record of a node of the 4-wide BVH, 4 words of uvec4 (64 bytes), and the meaning of its child references.
//
//   0: origin.xyz, exponents (byte a: biased exponent of scale on axis a)
//   1: q_lo.xyz, q_hi.x (byte i of each: child i)
//   2: q_hi.yz, 0, 0
//   3: reference of child 0, 1, 2, 3
//
// The box of child i is [origin + q_lo * scale, origin + q_hi * scale] in float arithmetic. The product is
// exact, so a fused multiply-add gives the same box. It is rounded outwards: it contains all that is below
// it.
#ifndef SHARED_BVH_NODE_H
#define SHARED_BVH_NODE_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint BVH_NODE_WORDS = 4u;
const uint BVH_WIDTH = 4u;

// Entries of a traversal's stack: one for each node on the way down that has children left to visit. So no
// tree has more levels than this; the builder sees to it. A balanced tree over 2^28 primitives has 13 levels;
// the rest lets the surface area heuristic be unbalanced. (A sphere of 10 M triangles has 19 levels.)
const uint BVH_STACK_SIZE = 32u;

// A tree has fewer nodes than this: an entry of the stack keeps 24 bits for the node.
const uint BVH_MAX_NODES = 1u << 24u;

// A child reference has BVH_LEAF_BIT set: a leaf, with its number of primitives (0 .. 7) from BVH_COUNT_SHIFT
// up and its first position in leaf order below; or names a node. No child is a leaf of nothing, BVH_EMPTY: a
// ray may meet its box, which means nothing, at no harm.
const uint BVH_LEAF_BIT = 0x80000000u;
const uint BVH_COUNT_SHIFT = 28u;
const uint BVH_COUNT_MASK = 7u;
const uint BVH_FIRST_MASK = 0x0FFFFFFFu;
const uint BVH_EMPTY = BVH_LEAF_BIT;

// A decoded node.
struct BvhNode {
    vec3 origin;  // World space [m].
    vec3 scale;   // Metres per step, on each axis a positive normal power of two.
    uvec3 q_lo;   // Byte i of each component: child i.
    uvec3 q_hi;
    uvec4 child;  // References; those that exist come first.
};

#ifdef __cplusplus

using PackedBvhNode = std::array<uvec4, BVH_NODE_WORDS>;
static_assert(sizeof(PackedBvhNode) == 64);

inline vec3 uintBitsToFloat(uvec3 v) {
    return std::bit_cast<vec3>(v);
}

inline PackedBvhNode pack(const BvhNode& n) {
    const uvec3 exponent = std::bit_cast<uvec3>(n.scale) >> 23u;
    return {words(n.origin, exponent.x | exponent.y << 8 | exponent.z << 16), uvec4(n.q_lo, n.q_hi.x),
            uvec4(n.q_hi.y, n.q_hi.z, 0u, 0u), n.child};
}

inline BvhNode bvh_node_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d);

#endif

// Decodes a record. Both languages read this, so that the host checks the very boxes that the device sees.
BvhNode bvh_node_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
    BvhNode n;
    n.origin = uintBitsToFloat(uvec3(a));
    n.scale = uintBitsToFloat((uvec3(a.w, a.w >> 8, a.w >> 16) & 0xFFu) << 23u);
    n.q_lo = uvec3(b);
    n.q_hi = uvec3(b.w, c.x, c.y);
    n.child = d;
    return n;
}

#ifdef __cplusplus

inline BvhNode unpack(const PackedBvhNode& n) {
    return bvh_node_unpack(n[0], n[1], n[2], n[3]);
}

// The decoded box of child i, in 0 .. BVH_WIDTH - 1.
inline Box child_box(const BvhNode& n, uint i) {
    return {n.origin + vec3((n.q_lo >> 8u * i) & 0xFFu) * n.scale,
            n.origin + vec3((n.q_hi >> 8u * i) & 0xFFu) * n.scale};
}

// Reference to a leaf of `count` primitives (1 .. BVH_COUNT_MASK) from position `first` (<= BVH_FIRST_MASK)
// in leaf order.
inline uint leaf_reference(uint first, uint count) {
    return BVH_LEAF_BIT | count << BVH_COUNT_SHIFT | first;
}

inline bool is_leaf(uint reference) {
    return (reference & BVH_LEAF_BIT) != 0u && reference != BVH_EMPTY;
}

inline uint leaf_first(uint reference) {
    return reference & BVH_FIRST_MASK;
}

inline uint leaf_count(uint reference) {
    return reference >> BVH_COUNT_SHIFT & BVH_COUNT_MASK;
}

}  // namespace candela
#endif

#endif
