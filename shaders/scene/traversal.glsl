// Rays against the scene's BVH: the closest hit, and whether there is any.
#ifndef SCENE_TRAVERSAL_GLSL
#define SCENE_TRAVERSAL_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "base/math.glsl"
#include "scene/list.glsl"
#include "scene/primitive.glsl"
#include "scene/scene_data.glsl"

// Before an invocation's first ray.
void bvh_prepare() {
    list_prepare();
}

// The four bytes of a word as floats.
vec4 bytes(uint word) {
    return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u);
}

// The bits of a float, as an integer that orders numbers >= 0 as the floats do, is negative for all others, and orders
// those the other way round. Comparing integers is one instruction where floats, for the sake of NaN, take three on
// software Vulkan.
ivec4 ordered_bits(vec4 x) {
    return floatBitsToInt(x);
}

// Four boxes and a ray.
struct BoxHits {
    bvec4 met;
    ivec4 t;  // Where the ray enters each box, as the bits of a float, or a negative number if it begins inside.
};

// Intersects a ray, clipped to [0, t_max], with the boxes whose nearer planes lie at `near + q_near * scale` along
// the ray, axis by axis, and the others at `far + q_far * scale`; byte i of q: box i.
//
// There is no need to clip to 0. A box that lies behind the ray has a far plane behind it, and all its near planes
// further behind. The order of negative integers makes t_far the far plane that is least behind, t_near the near plane
// that is most behind, and t_near the greater of the two: the box is not met.
BoxHits boxes_intersect(uvec3 q_near, uvec3 q_far, vec3 scale, vec3 near, vec3 far, float t_max) {
    ivec4 t_near = max(max(ordered_bits(bytes(q_near.x) * scale.x + near.x),
                           ordered_bits(bytes(q_near.y) * scale.y + near.y)),
                       ordered_bits(bytes(q_near.z) * scale.z + near.z));
    ivec4 t_far = min(min(ordered_bits(bytes(q_far.x) * scale.x + far.x),
                          ordered_bits(bytes(q_far.y) * scale.y + far.y)),
                      min(ordered_bits(bytes(q_far.z) * scale.z + far.z), ordered_bits(vec4(t_max))));
    return BoxHits(lessThanEqual(t_near, t_far), t_near);
}

// The children of a node whose boxes a ray meets.
struct NodeHits {
    uint nodes;    // Bit i: child i, a node.
    uint leaves;   // Bit i: the primitive i places behind the node's first.
    uint nearest;  // The one of `nodes` that the ray enters first, if there is any.
};

// Whether both hold, component by component.
bvec4 both(bvec4 a, bvec4 b) {
    return bvec4(a.x && b.x, a.y && b.y, a.z && b.z, a.w && b.w);
}

// The ones of four boxes that are nodes, where each is that child of a node of which so many are: where the ray enters
// them, with the child in the low 3 bits; or more than any of those.
ivec4 node_order(BoxHits hits, uvec4 children, uint node_count) {
    const int miss = 0x7FFFFFFF;
    bvec4 nodes = both(hits.met, lessThan(children, uvec4(node_count)));
    return mix(ivec4(miss), (hits.t & ~7) | ivec4(children), nodes);
}

// The children of a node whose boxes the ray meets, clipped to [0, t_max]; inv_d: reciprocals(ray.d).
//
// Conservative: both ends of every slab are moved outwards by 2^-20 of the largest number that took part in the
// sum, which covers the roundings of the difference, the reciprocal (2.5 ulp in Vulkan) and the products, as well
// as those of the bounds in triangles_intersect. So a triangle is never culled by a box that contains it.
// Ref: Ize 2013, Robust BVH Ray Traversal, for the problem; the bound is our own, for quantised boxes.
NodeHits node_intersect(BvhNode node, Ray ray, vec3 inv_d, float t_max) {
    vec3 scale = node.scale * inv_d;
    vec3 start = (node.origin - ray.o) * inv_d;
    vec3 margin = (abs(start) + 256.0 * abs(scale)) * (1.0 / 1048576.0);
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
    // From very far away, all boxes of a node are met, even those of children that do not exist.
    uint met = (bits.x | bits.y | bits.z | bits.w) & (2u << bvh_last_child(node.children)) - 1u;
    return NodeHits(met & (1u << node_count) - 1u, met >> node_count,
                    uint(min(min(first.x, first.y), min(first.z, first.w))) & 7u);
}

// Children of a node that are still to be visited, all of them nodes: bit PENDING_SHIFT + i: child i; below those bits
// the index of the first.
const uint PENDING_SHIFT = 24u;
const uint PENDING_NONE = 0u;

bool pending_any(uint pending) {
    return pending >> PENDING_SHIFT != 0u;
}

// The lowest of them; undefined if there is none.
uint pending_first(uint pending) {
    return uint(findLSB(pending >> PENDING_SHIFT));
}

// The index of one of them.
uint pending_node(uint pending, uint child) {
    return (pending & (BVH_MAX_NODES - 1u)) + child;
}

// Without the lowest, if there is any.
uint pending_rest(uint pending) {
    return pending & (pending - (1u << PENDING_SHIFT));
}

// The stack of bvh_advance, its top at 0: what is left to visit of each node on the way down, and none below them. The
// root has no siblings, and those of the node to be visited are not here. All of it moves with every entry, so that no
// index depends on the ray and the array becomes registers: on software Vulkan a store to an indexed array takes longer
// than moving ten words. (The loops count with signed numbers, or lavapipe 22.3 would not unroll them.) Handed to a
// function as an argument it would be copied.
const int STACK_WORDS = BVH_DEPTH > 1u ? int(BVH_DEPTH) - 1 : 1;
uint stack[STACK_WORDS];

// Takes the top away if `pop`, or puts `pending` there if `push`. It selects instead of branching, or lavapipe 22.3
// would move every word twice.
void stack_move(bool pop, bool push, uint pending) {
    [[unroll]] for (int k = 0; k < STACK_WORDS - 1; ++k) stack[k] = mix(stack[k], stack[k + 1], pop);
    [[unroll]] for (int k = STACK_WORDS - 1; k > 0; --k) stack[k] = mix(stack[k], stack[k - 1], push);
    stack[0] = mix(stack[0], pending, push);
}

// In place of a node: there is none.
const uint NODE_NONE = 0xFFFFFFFFu;

// A ray on its way through the tree.
struct Traversal {
    Ray ray;
    vec3 inv_d;  // reciprocals(ray.d)
    RayShear shear;
    bool any_hit;     // The first hit is the end.
    Hit hit;          // The nearest so far; t is t_max where there is none.
    uint node;        // To be visited next,
    uint pending;     // and then its siblings; those further up are on the stack.
    uint leaves;      // To be tested before: bit i: the primitive i places behind
    uint first_leaf;  // this position in leaf order.
};

// Before the root, looking for hits with t in (0, t_max). bvh_prepare comes first.
Traversal bvh_begin(Ray ray, float t_max, bool any_hit) {
    stack[0] = PENDING_NONE;
    vec3 inv_d = reciprocals(ray.d);
    return Traversal(ray, inv_d, ray_shear(ray.d, inv_d), any_hit, Hit(t_max, 0u), 0u, PENDING_NONE, 0u, 0u);
}

// With no node left to visit, and no leaf to be tested.
void bvh_end(inout Traversal t) {
    t.node = NODE_NONE;
    t.leaves = 0u;
}

bool bvh_ended(Traversal t) {
    return t.node == NODE_NONE && t.leaves == 0u;
}

// Takes a ray on to the next leaves, and past them; not one that has ended.
//
// Leaves are tested as soon as they are met, and never wait on the stack, of which one word a level is enough then. On
// software Vulkan the rays of neighbouring lanes wait for each other at the end of either loop.
void bvh_advance(inout Traversal t) {
    if (LIST > 0u) {
        list_intersect(t.ray, t.shear, t.hit);
        bvh_end(t);
        return;
    }

    // Go on: to the nearest child, or to the siblings as they come, or up.
    while (t.leaves == 0u && t.node != NODE_NONE) {
        // What is next if this node has no child to visit.
        bool siblings = pending_any(t.pending);
        uint next = mix(stack[0], t.pending, siblings);
        uint next_node = mix(NODE_NONE, pending_node(next, pending_first(next)), pending_any(next));

        BvhNode node = scene_node(t.node);
        NodeHits met = node_intersect(node, t.ray, t.inv_d, t.hit.t);
        t.leaves = met.leaves;
        t.first_leaf = bvh_first_primitive(node.children);
        bool down = met.nodes != 0u;
        uint others = met.nodes & ~(1u << met.nearest);
        stack_move(!down && !siblings, down && siblings, t.pending);
        t.pending = mix(pending_rest(next), node.children.x | others << PENDING_SHIFT, down);
        t.node = mix(next_node, node.children.x + met.nearest, down);
    }

    // Test the leaves.
    float t_max = t.hit.t;
    while (t.leaves != 0u) {
        uint position = t.first_leaf + uint(findLSB(t.leaves));
        t.leaves &= t.leaves - 1u;
        primitive_intersect(t.ray, t.shear, scene_primitive(position), position, t.hit);
    }
    if (t.any_hit && t.hit.t < t_max) bvh_end(t);
}

// The closest hit with t > 0; Hit::t is FLOAT_MAX where there is none.
Hit bvh_intersect(Ray ray) {
    bvh_prepare();
    Traversal t = bvh_begin(ray, FLOAT_MAX, false);
    while (!bvh_ended(t)) bvh_advance(t);
    return t.hit;
}

// True if any primitive meets the ray with t in (0, t_max).
bool bvh_occluded(Ray ray, float t_max) {
    bvh_prepare();
    Traversal t = bvh_begin(ray, t_max, true);
    while (!bvh_ended(t)) bvh_advance(t);
    return t.hit.t < t_max;
}

// The place of the triangle, sphere or disk in the scene's own order; 0 for no hit.
uint hit_id(Hit hit) {
    if (hit.t == FLOAT_MAX) return 0u;
    uvec2 id = scene_surface(hit.place / 2u).id;
    return (hit.place & 1u) == 0u ? id.x : id.y;
}

#endif
