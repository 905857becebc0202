// Rays against the scene's BVH: the closest hit, and whether there is any.
#ifndef SCENE_TRAVERSAL_GLSL
#define SCENE_TRAVERSAL_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "base/math.glsl"
#include "scene/primitive.glsl"
#include "scene/scene_data.glsl"

// A tiny scene needs no tree: where all lanes go together, as on software Vulkan, they test all of its primitives in
// less time than they take to find out which, since none waits for another. The primitives are read once and stay in
// registers, or in what the driver makes of so many.
layout(constant_id = CONSTANT_LIST) const uint LIST = 0u;

Primitive list[LIST_MAX];

// Before an invocation's first ray.
void bvh_prepare() {
    [[unroll]] for (int i = 0; i < int(LIST); ++i) list[i] = scene_primitive(uint(i));
}

// What a ray needs once for all boxes.
struct RaySlabs {
    vec3 o;
    vec3 inv_d;
    bvec3 negative;
};

RaySlabs ray_slabs(Ray ray) {
    vec3 inv_d = reciprocals(ray.d);
    return RaySlabs(ray.o, inv_d, lessThan(inv_d, vec3(0.0)));
}

// The four bytes of a word as floats.
vec4 bytes(uint word) {
    return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u);
}

// The bits of a float, as an integer that orders numbers >= 0 as the floats do and is negative for all others.
// Comparing those is one instruction where floats, for the sake of NaN, take three on software Vulkan.
ivec4 ordered_bits(vec4 x) {
    return floatBitsToInt(x);
}

// Above all distances that node_intersect returns for a hit; the low two bits are free.
const uint NODE_MISS = 0x7F7FFFFCu;

// Where the ray enters the box of each of a node's children, clipped to [0, t_max], as the bits of a float; NODE_MISS
// where it does not.
//
// Conservative: both ends of every slab are moved outwards by 2^-20 of the largest number that took part in the
// sum, which covers the roundings of the difference, the reciprocal (2.5 ulp in Vulkan) and the products, as well
// as those of the bounds in triangles_intersect. So a triangle is never culled by a box that contains it.
// Ref: Ize 2013, Robust BVH Ray Traversal, for the problem; the bound is our own, for quantised boxes.
uvec4 node_intersect(BvhNode node, RaySlabs ray, float t_max) {
    vec3 scale = node.scale * ray.inv_d;
    vec3 start = (node.origin - ray.o) * ray.inv_d;
    vec3 margin = (abs(start) + 256.0 * abs(scale)) * (1.0 / 1048576.0);
    vec3 near = start - margin;
    vec3 far = start + margin;
    uvec3 q_near = mix(node.q_lo, node.q_hi, ray.negative);
    uvec3 q_far = mix(node.q_hi, node.q_lo, ray.negative);
    ivec4 t_near = max(max(ordered_bits(bytes(q_near.x) * scale.x + near.x),
                           ordered_bits(bytes(q_near.y) * scale.y + near.y)),
                       max(ordered_bits(bytes(q_near.z) * scale.z + near.z), ivec4(0)));
    ivec4 t_far = min(min(ordered_bits(bytes(q_far.x) * scale.x + far.x),
                          ordered_bits(bytes(q_far.y) * scale.y + far.y)),
                      min(ordered_bits(bytes(q_far.z) * scale.z + far.z), ordered_bits(vec4(t_max))));
    return mix(uvec4(NODE_MISS), uvec4(t_near) & ~3u, lessThanEqual(t_near, t_far));
}

// Children of a node that are still to be visited, the nearest first.
struct Pending {
    uint node;
    uvec2 children;  // The node's.
    uint slots;      // Two bits each, the next one lowest.
    uint count;      // 0 .. BVH_WIDTH
};

// The children that a ray meets, sorted by distance: the slot rides in the free bits of the distance through a
// sorting network of five exchanges.
Pending pending_children(uint node, uvec2 children, uvec4 t) {
    uvec4 k = t | uvec4(0u, 1u, 2u, 3u);
    k = uvec4(min(k.xz, k.yw), max(k.xz, k.yw));  // 0:1 2:3, the lesser ones in xy
    k = uvec4(min(k.xz, k.yw), max(k.xz, k.yw));  // lesser ones, greater ones: x is least, w greatest
    k.yz = uvec2(min(k.y, k.z), max(k.y, k.z));
    uint slots = (k.x & 3u) | (k.y & 3u) << 2u | (k.z & 3u) << 4u | (k.w & 3u) << 6u;
    uint count = uint(k.x < NODE_MISS) + uint(k.y < NODE_MISS) + uint(k.z < NODE_MISS) + uint(k.w < NODE_MISS);
    return Pending(node, children, slots, count);
}

// Takes the next one out of them, of which there is one at least; returns its reference.
uint pending_take(inout Pending p) {
    uint reference = bvh_child(p.children, p.slots & 3u);
    p.slots >>= 2u;
    --p.count;
    return reference;
}

// One word for the stack, never STACK_BOTTOM; at least one child has been visited, so three slots are enough.
uint pending_pack(Pending p) {
    return p.node | p.slots << 24u | p.count << 30u;
}

// Reads where the children are once more.
Pending pending_unpack(uint word) {
    uint node = word & (BVH_MAX_NODES - 1u);
    return Pending(node, scene_node_children(node), (word >> 24u) & 63u, word >> 30u);
}

// Levels of the scene's tree.
layout(constant_id = CONSTANT_BVH_DEPTH) const uint BVH_DEPTH = BVH_MAX_DEPTH;

// The stack of bvh_advance, its top at 0: a word for each node on the way down that has children left to visit, and
// STACK_BOTTOM below them. All of it moves with every word, so that no index depends on the ray and the array becomes
// registers: on software Vulkan a store to an indexed array takes longer than moving fourteen words. (The loops count
// with signed numbers, or lavapipe 22.3 would not unroll them.) Handed to a function as an argument it would be copied.
uint stack[BVH_DEPTH];

const uint STACK_BOTTOM = 0u;

void stack_push(uint word) {
    [[unroll]] for (int k = int(BVH_DEPTH) - 1; k > 0; --k) stack[k] = stack[k - 1];
    stack[0] = word;
}

uint stack_pop() {
    uint word = stack[0];
    [[unroll]] for (int k = 1; k < int(BVH_DEPTH); ++k) stack[k - 1] = stack[k];
    return word;
}

// No reference to visit before the stack is asked, and none at all.
const uint REFERENCE_WAIT = 0xFFFFFFFEu;
const uint REFERENCE_END = 0xFFFFFFFFu;

// A ray on its way through the tree.
struct Traversal {
    Ray ray;
    RaySlabs slabs;
    RayShear shear;
    bool any_hit;     // The first hit is the end.
    Hit hit;          // The nearest so far; t is t_max where there is none.
    uint reference;   // To be visited next.
    Pending pending;  // Siblings of `reference`; those further up are on the stack.
};

// Before the root, looking for hits with t in (0, t_max). bvh_prepare comes first.
Traversal bvh_begin(Ray ray, float t_max, bool any_hit) {
    stack[0] = STACK_BOTTOM;
    Pending nothing = Pending(0u, uvec2(0u), 0u, 0u);
    return Traversal(ray, ray_slabs(ray), ray_shear(ray.d), any_hit, Hit(t_max, 0u, vec2(0.0)), 0u, nothing);
}

bool bvh_ended(Traversal t) {
    return t.reference == REFERENCE_END;
}

// So many nodes a ray may visit before those that have come to a leaf go on. Where lanes go together and none skips
// what others do, as on software Vulkan, fewer would mean more tests of leaves for few rays, and more would mean that
// most rays wait for the one that has furthest to go.
const uint NODES_PER_TURN = 12u;

// Takes a ray some way on; not one that has ended.
void bvh_advance(inout Traversal t) {
    if (LIST > 0u) {
        [[unroll]] for (int i = 0; i < int(LIST); ++i) primitive_intersect(t.ray, t.shear, list[i], uint(i), t.hit);
        t.reference = REFERENCE_END;
        return;
    }

    // Go down, perhaps to a leaf. Where nothing is left to visit, wait: the stack is read once a turn.
    for (uint i = 0u; i < NODES_PER_TURN && (t.reference & BVH_LEAF_BIT) == 0u; ++i) {
        BvhNode node = scene_node(t.reference);
        Pending met = pending_children(t.reference, node.children, node_intersect(node, t.slabs, t.hit.t));
        if (met.count > 0u && t.pending.count > 0u) stack_push(pending_pack(t.pending));
        if (met.count > 0u) t.pending = met;
        t.reference = REFERENCE_WAIT;
        if (t.pending.count > 0u) t.reference = pending_take(t.pending);
    }
    if ((t.reference & BVH_LEAF_BIT) == 0u) return;

    // Test the leaf.
    if (t.reference != REFERENCE_WAIT) {
        float t_max = t.hit.t;
        uint position = t.reference & ~BVH_LEAF_BIT;
        primitive_intersect(t.ray, t.shear, scene_primitive(position), position, t.hit);
        if (t.any_hit && t.hit.t < t_max) {
            t.reference = REFERENCE_END;
            return;
        }
    }

    // Find what is next.
    if (t.pending.count == 0u) {
        uint word = stack_pop();
        if (word == STACK_BOTTOM) {
            t.reference = REFERENCE_END;
            return;
        }
        t.pending = pending_unpack(word);
    }
    t.reference = pending_take(t.pending);
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
