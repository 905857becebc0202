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

// What a ray needs once for all boxes.
struct RaySlabs {
    vec3 o;
    vec3 inv_d;
};

RaySlabs ray_slabs(Ray ray) {
    return RaySlabs(ray.o, reciprocals(ray.d));
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

// Four boxes and a ray.
struct BoxHits {
    bvec4 met;
    uvec4 t;  // Where the ray enters the box, as the bits of a float, with the box's slot in the low 3 bits; greater
              // than all of those where it does not meet the box.
};

const uint BOX_MISS = 0xFFFFFFFFu;

// Intersects a ray, clipped to [0, t_max], with the boxes whose nearer planes lie at `near + q_near * scale` along
// the ray, axis by axis, and the others at `far + q_far * scale`; byte i of q: box i.
BoxHits boxes_intersect(uvec3 q_near, uvec3 q_far, vec3 scale, vec3 near, vec3 far, float t_max, uvec4 slots) {
    ivec4 t_near = max(max(ordered_bits(bytes(q_near.x) * scale.x + near.x),
                           ordered_bits(bytes(q_near.y) * scale.y + near.y)),
                       max(ordered_bits(bytes(q_near.z) * scale.z + near.z), ivec4(0)));
    ivec4 t_far = min(min(ordered_bits(bytes(q_far.x) * scale.x + far.x),
                          ordered_bits(bytes(q_far.y) * scale.y + far.y)),
                      min(ordered_bits(bytes(q_far.z) * scale.z + far.z), ordered_bits(vec4(t_max))));
    bvec4 met = lessThanEqual(t_near, t_far);
    return BoxHits(met, mix(uvec4(BOX_MISS), (uvec4(t_near) & ~7u) | slots, met));
}

// Children of a node that are still to be visited.
struct Pending {
    uint nodes;       // Bit PENDING_SHIFT + i: child i; below those bits BvhNode::children.x.
    uint primitives;  // BvhNode::children.y
};

const uint PENDING_SHIFT = 24u;

Pending pending_none() {
    return Pending(0u, 0u);
}

bool pending_any(Pending p) {
    return p.nodes >> PENDING_SHIFT != 0u;
}

// The lowest slot of those, of which there is one at least.
uint pending_slot(Pending p) {
    return uint(findLSB(p.nodes >> PENDING_SHIFT));
}

// Takes the child at a slot out of them; returns its reference.
uint pending_take(inout Pending p, uint slot) {
    p.nodes ^= 1u << PENDING_SHIFT << slot;
    return bvh_child(uvec2(p.nodes & (BVH_MAX_NODES - 1u), p.primitives), slot);
}

// The children of a node whose boxes the ray meets, clipped to [0, t_max]; `nearest` is the slot of the one that it
// enters first, if there is any.
//
// Conservative: both ends of every slab are moved outwards by 2^-20 of the largest number that took part in the
// sum, which covers the roundings of the difference, the reciprocal (2.5 ulp in Vulkan) and the products, as well
// as those of the bounds in triangles_intersect. So a triangle is never culled by a box that contains it.
// Ref: Ize 2013, Robust BVH Ray Traversal, for the problem; the bound is our own, for quantised boxes.
Pending node_intersect(BvhNode node, RaySlabs ray, float t_max, out uint nearest) {
    vec3 scale = node.scale * ray.inv_d;
    vec3 start = (node.origin - ray.o) * ray.inv_d;
    vec3 margin = (abs(start) + 256.0 * abs(scale)) * (1.0 / 1048576.0);
    vec3 near = start - margin;
    vec3 far = start + margin;
    bvec3 negative = lessThan(ray.inv_d, vec3(0.0));
    BoxHits a = boxes_intersect(mix(node.q_lo[0], node.q_hi[0], negative), mix(node.q_hi[0], node.q_lo[0], negative),
                                scale, near, far, t_max, uvec4(0u, 1u, 2u, 3u));
    BoxHits b = boxes_intersect(mix(node.q_lo[1], node.q_hi[1], negative), mix(node.q_hi[1], node.q_lo[1], negative),
                                scale, near, far, t_max, uvec4(4u, 5u, 6u, 7u));
    uvec3 t = min(a.t.xyz, b.t.xyz);
    nearest = min(min(t.x, t.y), min(t.z, a.t.w)) & 7u;
    uvec4 slots = mix(uvec4(0u), uvec4(1u, 2u, 4u, 8u) << PENDING_SHIFT, a.met);
    slots.xyz |= mix(uvec3(0u), uvec3(16u, 32u, 64u) << PENDING_SHIFT, b.met.xyz);
    uint met = slots.x | slots.y | slots.z | slots.w;
    // From very far away, all boxes of a node are met, even those of children that do not exist; none of these begins
    // before one that does.
    uint existing = (2u << PENDING_SHIFT << bvh_last_child(node.children)) - 1u;
    return Pending(node.children.x | (met & existing), node.children.y);
}

// Levels of the scene's tree.
layout(constant_id = CONSTANT_BVH_DEPTH) const uint BVH_DEPTH = BVH_MAX_DEPTH;

// The stack of bvh_advance, its top at 0: the children left to visit of each node on the way down, and none below
// them. All of it moves with every entry, so that no index depends on the ray and the arrays become registers: on
// software Vulkan a store to an indexed array takes longer than moving fourteen words. (The loops count with signed
// numbers, or lavapipe 22.3 would not unroll them.) Handed to a function as an argument they would be copied.
uint stack_nodes[BVH_DEPTH];
uint stack_primitives[BVH_DEPTH];

// Puts p on the stack if it is asked to. It selects instead of branching, and from the bottom up: so lavapipe 22.3
// moves every word once, otherwise twice.
void stack_push(Pending p, bool push) {
    [[unroll]] for (int k = int(BVH_DEPTH) - 1; k > 0; --k) {
        stack_nodes[k] = mix(stack_nodes[k], stack_nodes[k - 1], push);
        stack_primitives[k] = mix(stack_primitives[k], stack_primitives[k - 1], push);
    }
    stack_nodes[0] = mix(stack_nodes[0], p.nodes, push);
    stack_primitives[0] = mix(stack_primitives[0], p.primitives, push);
}

Pending stack_pop() {
    Pending p = Pending(stack_nodes[0], stack_primitives[0]);
    [[unroll]] for (int k = 1; k < int(BVH_DEPTH); ++k) {
        stack_nodes[k - 1] = stack_nodes[k];
        stack_primitives[k - 1] = stack_primitives[k];
    }
    return p;
}

// Nothing to visit. (As a leaf, further than any.)
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
    stack_nodes[0] = pending_none().nodes;
    RaySlabs slabs = ray_slabs(ray);
    RayShear shear = ray_shear(ray.d, slabs.inv_d);
    return Traversal(ray, slabs, shear, any_hit, Hit(t_max, 0u), 0u, pending_none());
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
        list_intersect(t.ray, t.shear, t.hit);
        t.reference = REFERENCE_END;
        return;
    }

    // Go on, perhaps to a leaf: first to the nearest child, then to its siblings as they come, then up.
    for (uint i = 0u; i < NODES_PER_TURN && (t.reference & BVH_LEAF_BIT) == 0u; ++i) {
        uint slot;
        Pending met = node_intersect(scene_node(t.reference), t.slabs, t.hit.t, slot);
        bool down = pending_any(met);
        stack_push(t.pending, down && pending_any(t.pending));
        t.pending.nodes = mix(t.pending.nodes, met.nodes, down);
        t.pending.primitives = mix(t.pending.primitives, met.primitives, down);
        if (!pending_any(t.pending)) t.pending = stack_pop();
        slot = mix(pending_slot(t.pending), slot, down);
        t.reference = REFERENCE_END;
        if (pending_any(t.pending)) t.reference = pending_take(t.pending, slot);
    }
    if ((t.reference & BVH_LEAF_BIT) == 0u || t.reference == REFERENCE_END) return;

    // Test the leaf.
    float t_max = t.hit.t;
    uint position = t.reference & ~BVH_LEAF_BIT;
    primitive_intersect(t.ray, t.shear, scene_primitive(position), position, t.hit);
    t.reference = REFERENCE_END;
    if (t.any_hit && t.hit.t < t_max) return;

    // Find what is next.
    if (!pending_any(t.pending)) t.pending = stack_pop();
    if (pending_any(t.pending)) t.reference = pending_take(t.pending, pending_slot(t.pending));
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
