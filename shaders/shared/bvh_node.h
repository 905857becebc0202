// Record of a node of the 7-wide BVH, 4 words of uvec4 (64 bytes, one line of most caches).
//
//   0: origin.xyz, exponents (byte a: biased exponent of scale on axis a) and byte 3 of children.y
//   1: q_lo[0].xyz, q_hi[0].x (byte i of each: child i)
//   2: q_hi[0].yz, q_lo[1].xy
//   3: q_lo[1].z, q_hi[1].xyz (byte i of [1]: child 4 + i; byte 3 of q_lo[1]: a byte of children.x,
//      of q_hi[1]: one of children.y)
//
// The box of child i is [origin + q_lo * scale, origin + q_hi * scale] in float arithmetic. The product is
// exact, so a fused multiply-add gives the same box. The box is rounded outwards: it contains everything
// below the child.
//
// Children that are nodes come first, and are adjacent in the array of nodes; those that are primitives are
// adjacent in leaf order. So two numbers give the places of all children.
#ifndef SHARED_BVH_NODE_H
#define SHARED_BVH_NODE_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint BVH_NODE_WORDS = 4u;
const uint BVH_WIDTH = 7u;

// The most levels of nodes in a tree, which the builder ensures. Halving 2^26 primitives needs 26 levels; the
// rest is for the imbalance of the surface area heuristic. (A sphere of 10 M triangles has 15 levels.)
const uint BVH_MAX_DEPTH = 48u;

// A tree has fewer nodes than this: with 24 bits for the index of a node, a word of traversal's stack has
// room for one bit per child.
const uint BVH_MAX_NODES = 1u << 24u;

// A tree has at most this many primitives.
const uint BVH_MAX_PRIMITIVES = (1u << 26u) - 1u;

// A reference with this bit is a position in leaf order; one without it is the index of a node.
const uint BVH_LEAF_BIT = 0x80000000u;

// A decoded node.
struct BvhNode {
    vec3 origin;    // In the frame of the scene.
    vec3 scale;     // Metres per step, on each axis a positive normal power of two.
    uvec3 q_lo[2];  // Byte i of each component of [0]: child i; of [1]: child 4 + i.
    uvec3 q_hi[2];
    uvec2 children;  // x: index of the first child that is a node; y: position of the first that is a
                     // primitive, and above it two counts; see bvh_children.
};

#ifdef __cplusplus

using PackedBvhNode = std::array<uvec4, BVH_NODE_WORDS>;
static_assert(sizeof(PackedBvhNode) == 64);

inline vec3 uintBitsToFloat(uvec3 v) {
    return std::bit_cast<vec3>(v);
}

inline PackedBvhNode pack(const BvhNode& n) {
    const uvec3 exponent = std::bit_cast<uvec3>(n.scale) >> 23u;
    const uvec3 node_bytes = uvec3(n.children.x, n.children.x >> 8u, n.children.x >> 16u) << 24u;
    const uvec3 primitive_bytes = uvec3(n.children.y, n.children.y >> 8u, n.children.y >> 16u) << 24u;
    const uvec3 q_lo = (n.q_lo[1] & 0xFFFFFFu) | node_bytes;
    const uvec3 q_hi = (n.q_hi[1] & 0xFFFFFFu) | primitive_bytes;
    return {word(n.origin, exponent.x | exponent.y << 8 | exponent.z << 16 | (n.children.y & 0xFF000000u)),
            uvec4(n.q_lo[0], n.q_hi[0].x), uvec4(n.q_hi[0].y, n.q_hi[0].z, q_lo.x, q_lo.y),
            uvec4(q_lo.z, q_hi.x, q_hi.y, q_hi.z)};
}

// BvhNode::children for `count` (1 .. BVH_WIDTH) children: `nodes` of them from index `first_node`, the rest
// from position `first_primitive` in leaf order.
inline uvec2 bvh_children(uint nodes, uint first_node, uint count, uint first_primitive) {
    return {first_node, first_primitive | nodes << 26u | (count - 1u) << 29u};
}

inline BvhNode bvh_node_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d);
inline uint bvh_node_count(uvec2 children);
inline uint bvh_first_primitive(uvec2 children);
inline uint bvh_last_child(uvec2 children);
inline uint bvh_longest_axis(vec3 scale);

#endif

// Decodes a record. Both languages use this, so the host checks exactly the boxes that the device sees.
BvhNode bvh_node_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
    BvhNode n;
    n.origin = uintBitsToFloat(uvec3(a));
    n.scale = uintBitsToFloat((uvec3(a.w, a.w >> 8, a.w >> 16) & 0xFFu) << 23u);
    n.q_lo[0] = uvec3(b);
    n.q_hi[0] = uvec3(b.w, c.x, c.y);
    uvec3 lo = uvec3(c.z, c.w, d.x);
    uvec3 hi = uvec3(d.y, d.z, d.w);
    n.q_lo[1] = lo & 0xFFFFFFu;
    n.q_hi[1] = hi & 0xFFFFFFu;
    n.children.x = lo.x >> 24u | lo.y >> 24u << 8u | lo.z >> 24u << 16u;
    n.children.y = hi.x >> 24u | hi.y >> 24u << 8u | hi.z >> 24u << 16u | a.w >> 24u << 24u;
    return n;
}

// The number of a node's children that are nodes: the first ones, from index children.x on.
uint bvh_node_count(uvec2 children) {
    return children.y >> 26u & 7u;
}

// Position in leaf order of the first child that is a primitive.
uint bvh_first_primitive(uvec2 children) {
    return children.y & BVH_MAX_PRIMITIVES;
}

// The last of a node's children, which are 0 .. bvh_last_child.
uint bvh_last_child(uvec2 children) {
    return children.y >> 29u;
}

// The axis on which a node is longest, by its scale; of several, the first. Trees of scenes with instances
// have the children that are nodes in ascending order of their boxes' middles along it.
uint bvh_longest_axis(vec3 scale) {
    if (scale.x >= scale.y && scale.x >= scale.z) return 0u;
    return scale.y >= scale.z ? 1u : 2u;
}

#ifdef __cplusplus

inline BvhNode unpack(const PackedBvhNode& n) {
    return bvh_node_unpack(n[0], n[1], n[2], n[3]);
}

// The reference to child i.
inline uint bvh_child(uvec2 children, uint i) {
    const uint nodes = bvh_node_count(children);
    return i < nodes ? children.x + i : BVH_LEAF_BIT | (bvh_first_primitive(children) + i - nodes);
}

// The number of a node's children. (The root of an empty tree has one that does not exist.)
inline uint bvh_child_count(const BvhNode& n) {
    return bvh_last_child(n.children) + 1u;
}

// The decoded box of child i, in 0 .. BVH_WIDTH - 1.
inline Box child_box(const BvhNode& n, uint i) {
    const uint shift = 8u * (i % 4u);
    return {n.origin + vec3((n.q_lo[i / 4u] >> shift) & 0xFFu) * n.scale,
            n.origin + vec3((n.q_hi[i / 4u] >> shift) & 0xFFu) * n.scale};
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
