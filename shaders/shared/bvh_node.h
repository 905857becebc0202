// Record of a node of the 4-wide BVH, 3 words of uvec4 (48 bytes).
//
//   0: origin.xyz, exponents (byte a: biased exponent of scale on axis a)
//   1: q_lo.xyz, q_hi.x (byte i of each: child i)
//   2: q_hi.yz, children.xy
//
// The box of child i is [origin + q_lo * scale, origin + q_hi * scale] in float arithmetic. The product is
// exact, so a fused multiply-add gives the same box. It is rounded outwards: it contains all that is below
// it.
//
// Children that are nodes come first and stand side by side in the array of nodes, as do those that are
// primitives in leaf order; so it takes two words to say where all are (bvh_child reads them).
#ifndef SHARED_BVH_NODE_H
#define SHARED_BVH_NODE_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint BVH_NODE_WORDS = 3u;
const uint BVH_WIDTH = 4u;

// No tree has more levels of nodes than this; the builder sees to it. A balanced tree over 2^28 primitives
// has 14 levels; the rest lets the surface area heuristic be unbalanced. (A sphere of 10 M triangles has 19
// levels.)
const uint BVH_MAX_DEPTH = 32u;

// A tree has fewer nodes than this: a reference to a group of nodes keeps 24 bits for the first, as does an
// entry of traversal's stack.
const uint BVH_MAX_NODES = 1u << 24u;

// A tree has at most so many primitives.
const uint BVH_MAX_PRIMITIVES = 0x0FFFFFFFu;

// A reference has this bit set and is a position in leaf order; or it is the index of a node.
const uint BVH_LEAF_BIT = 0x80000000u;

// A decoded node.
struct BvhNode {
    vec3 origin;  // World space [m].
    vec3 scale;   // Metres per step, on each axis a positive normal power of two.
    uvec3 q_lo;   // Byte i of each component: child i.
    uvec3 q_hi;
    uvec2 children;  // Where they are.
};

#ifdef __cplusplus

using PackedBvhNode = std::array<uvec4, BVH_NODE_WORDS>;
static_assert(sizeof(PackedBvhNode) == 48);

inline vec3 uintBitsToFloat(uvec3 v) {
    return std::bit_cast<vec3>(v);
}

inline PackedBvhNode pack(const BvhNode& n) {
    const uvec3 exponent = std::bit_cast<uvec3>(n.scale) >> 23u;
    return {words(n.origin, exponent.x | exponent.y << 8 | exponent.z << 16), uvec4(n.q_lo, n.q_hi.x),
            uvec4(n.q_hi.y, n.q_hi.z, n.children)};
}

// The children of a node: `nodes` of them from index `first_node`, the rest of `count` (1 .. BVH_WIDTH) from
// position `first_primitive` in leaf order.
inline uvec2 bvh_children(uint nodes, uint first_node, uint count, uint first_primitive) {
    return {first_node | nodes << 24u | (count - 1u) << 27u, first_primitive};
}

inline BvhNode bvh_node_unpack(uvec4 a, uvec4 b, uvec4 c);
inline uint bvh_child(uvec2 children, uint i);

#endif

// Decodes a record. Both languages read this, so that the host checks the very boxes that the device sees.
BvhNode bvh_node_unpack(uvec4 a, uvec4 b, uvec4 c) {
    BvhNode n;
    n.origin = uintBitsToFloat(uvec3(a));
    n.scale = uintBitsToFloat((uvec3(a.w, a.w >> 8, a.w >> 16) & 0xFFu) << 23u);
    n.q_lo = uvec3(b);
    n.q_hi = uvec3(b.w, c.x, c.y);
    n.children = uvec2(c.z, c.w);
    return n;
}

// The reference to child i. A ray may meet the box of a child that does not exist, which means nothing: it
// gets the last child, at no harm, since where the builder leaves room all children are leaves.
uint bvh_child(uvec2 children, uint i) {
    uint nodes = children.x >> 24u & 7u;
    uint last = children.x >> 27u;
    if (i > last) i = last;
    return i < nodes ? (children.x & (BVH_MAX_NODES - 1u)) + i : BVH_LEAF_BIT | (children.y + i - nodes);
}

#ifdef __cplusplus

inline BvhNode unpack(const PackedBvhNode& n) {
    return bvh_node_unpack(n[0], n[1], n[2]);
}

// How many children a node has. (The root of an empty tree has one that does not exist.)
inline uint bvh_child_count(const BvhNode& n) {
    return (n.children.x >> 27u) + 1u;
}

// The decoded box of child i, in 0 .. BVH_WIDTH - 1.
inline Box child_box(const BvhNode& n, uint i) {
    return {n.origin + vec3((n.q_lo >> 8u * i) & 0xFFu) * n.scale,
            n.origin + vec3((n.q_hi >> 8u * i) & 0xFFu) * n.scale};
}

inline bool is_leaf(uint reference) {
    return (reference & BVH_LEAF_BIT) != 0u;
}

// The position in leaf order that a leaf's reference names.
inline uint leaf_position(uint reference) {
    return reference & ~BVH_LEAF_BIT;
}

}  // namespace candela
#endif

#endif
