// Ray against the boxes of a node's children.
#ifndef SCENE_NODE_GLSL
#define SCENE_NODE_GLSL

#include "base/math.glsl"
#include "base/ray.glsl"
#include "shared/bvh_node.h"
#include "shared/instance.h"

// The four bytes of a word as floats.
vec4 bytes(uint word) {
    return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u);
}

// The bits of a float as an integer. Such integers order numbers >= 0 as floats do; all others become negative, in
// reverse order. On software Vulkan, comparing integers is one instruction, comparing floats three, to handle NaN.
ivec4 ordered_bits(vec4 x) {
    return floatBitsToInt(x);
}

// The hits of a ray with four boxes.
struct BoxHits {
    bvec4 met;
    ivec4 t;  // Where the ray enters each box, as the bits of a float; negative if it begins inside.
};

// Intersects a ray, clipped to [0, t_max], with the boxes whose nearer planes lie at `near + q_near * scale` along the
// ray, axis by axis, and the others at `far + q_far * scale`; byte i of q: box i.
//
// Clipping to 0 is not necessary. A box behind the ray's origin has a far plane behind it, and that axis's near plane
// even further behind. So t_far is the far plane that is least behind, by the order of negative integers; t_near is a
// plane in front of the origin, or the near plane that is most behind. Either way t_near is greater, and the ray misses
// the box.
BoxHits boxes_intersect(uvec3 q_near, uvec3 q_far, vec3 scale, vec3 near, vec3 far, float t_max) {
    ivec4 t_near =
        max(max(ordered_bits(bytes(q_near.x) * scale.x + near.x), ordered_bits(bytes(q_near.y) * scale.y + near.y)),
            ordered_bits(bytes(q_near.z) * scale.z + near.z));
    ivec4 t_far =
        min(min(ordered_bits(bytes(q_far.x) * scale.x + far.x), ordered_bits(bytes(q_far.y) * scale.y + far.y)),
            min(ordered_bits(bytes(q_far.z) * scale.z + far.z), ordered_bits(vec4(t_max))));
    return BoxHits(lessThanEqual(t_near, t_far), t_near);
}

// The children of a node whose boxes a ray hits.
struct NodeHits {
    uint nodes;    // Bit i: child i, a node.
    uint leaves;   // Bit i: the primitive i places after the node's first.
    uint nearest;  // The one of `nodes` that the ray enters first, if there is any.
};

// Whether both hold, component by component.
bvec4 both(bvec4 a, bvec4 b) {
    return bvec4(a.x && b.x, a.y && b.y, a.z && b.z, a.w && b.w);
}

// Where the ray enters the boxes, among the four, that are nodes, with the child's number in the low 3 bits; a greater
// value for the others, and for a miss. `children`: the boxes' numbers; the first `node_count` children are nodes.
ivec4 node_order(BoxHits hits, uvec4 children, uint node_count) {
    const int miss = 0x7FFFFFFF;
    bvec4 nodes = both(hits.met, lessThan(children, uvec4(node_count)));
    return mix(ivec4(miss), (hits.t & ~7) | ivec4(children), nodes);
}

// The children of a node whose boxes the ray, clipped to [0, t_max], hits; inv_d: reciprocals(ray.d).
//
// Conservative: both ends of every slab are moved outwards by 2^-20 of the largest number in the sum, which covers the
// rounding of the difference, the reciprocal (2.5 ulp in Vulkan) and the products, as well as of the bounds in
// triangles_intersect. So a triangle is never culled by a box that contains it.
// Ref: Ize 2013, Robust BVH Ray Traversal, for the problem; the bound is our own, for quantised boxes.
//
// Above instances, a ray into whose space may be off by INSTANCE_RAY_ERROR of the largest coordinate of its origin, and
// by the margin of the instances' boxes.
NodeHits node_intersect(BvhNode node, Ray ray, vec3 inv_d, float t_max, bool above_instances) {
    vec3 scale = node.scale * inv_d;
    vec3 start = (node.origin - ray.o) * inv_d;
    vec3 margin = (abs(start) + 256.0 * abs(scale)) * (1.0 / 1048576.0);
    if (above_instances) margin += INSTANCE_RAY_ERROR * max_component(abs(ray.o)) * abs(inv_d);
    vec3 near = start - margin;
    vec3 far = start + margin;
    bvec3 negative = lessThan(inv_d, vec3(0.0));
    BoxHits a = boxes_intersect(mix(node.q_lo[0], node.q_hi[0], negative), mix(node.q_hi[0], node.q_lo[0], negative),
                                scale, near, far, t_max);
    BoxHits b = boxes_intersect(mix(node.q_lo[1], node.q_hi[1], negative), mix(node.q_hi[1], node.q_lo[1], negative),
                                scale, near, far, t_max);
    uint node_count = bvh_node_count(node.children);
    ivec4 first = node_order(a, uvec4(0u, 1u, 2u, 3u), node_count);
    first.xyz = min(first.xyz, node_order(b, uvec4(4u, 5u, 6u, 7u), node_count).xyz);
    uvec4 bits = mix(uvec4(0u), uvec4(1u, 2u, 4u, 8u), a.met);
    bits.xyz |= mix(uvec3(0u), uvec3(16u, 32u, 64u), b.met.xyz);
    // From very far away, a ray hits all boxes of a node, even those of missing children.
    uint met = (bits.x | bits.y | bits.z | bits.w) & (2u << bvh_last_child(node.children)) - 1u;
    return NodeHits(met & (1u << node_count) - 1u, met >> node_count,
                    uint(min(min(first.x, first.y), min(first.z, first.w))) & 7u);
}

// Whether a ray tends to meet a node's children from the last to the first.
bool node_descends(BvhNode node, Ray ray) {
    uint axis = bvh_longest_axis(node.scale);
    return (axis == 0u ? ray.d.x : axis == 1u ? ray.d.y : ray.d.z) < 0.0;
}

#endif
