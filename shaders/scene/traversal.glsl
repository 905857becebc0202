// Rays against the scene's BVH: the closest hit, and whether there is any.
#ifndef SCENE_TRAVERSAL_GLSL
#define SCENE_TRAVERSAL_GLSL

#include "base/math.glsl"
#include "scene/primitive.glsl"
#include "scene/scene_data.glsl"

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
    uint slots;  // Two bits each, the next one lowest.
    uint count;  // 0 .. BVH_WIDTH
};

// The children that a ray meets, sorted by distance: the slot rides in the free bits of the distance through a
// sorting network of five exchanges.
Pending pending_children(uint node, uvec4 t) {
    uvec4 k = t | uvec4(0u, 1u, 2u, 3u);
    k = uvec4(min(k.xz, k.yw), max(k.xz, k.yw));  // 0:1 2:3, the lesser ones in xy
    k = uvec4(min(k.xz, k.yw), max(k.xz, k.yw));  // lesser ones, greater ones: x is least, w greatest
    k.yz = uvec2(min(k.y, k.z), max(k.y, k.z));
    Pending p;
    p.node = node;
    p.slots = (k.x & 3u) | (k.y & 3u) << 2u | (k.z & 3u) << 4u | (k.w & 3u) << 6u;
    p.count = uint(k.x < NODE_MISS) + uint(k.y < NODE_MISS) + uint(k.z < NODE_MISS) + uint(k.w < NODE_MISS);
    return p;
}

// One word for the stack; at least one child has been visited, so three slots are enough.
uint pending_pack(Pending p) {
    return p.node | p.slots << 24u | p.count << 30u;
}

Pending pending_unpack(uint word) {
    return Pending(word & (BVH_MAX_NODES - 1u), (word >> 24u) & 63u, word >> 30u);
}

// The stack of bvh_advance. One word per level of the tree, not one per child: on software Vulkan a store to an
// indexed array is a loop over lanes with a branch in each, and was seen to take half of all time. Handed to
// pending_next as an argument it would be copied.
uint stack[BVH_STACK_SIZE];

const uint NO_REFERENCE = 0xFFFFFFFFu;

// The reference to visit next: of `pending`, or, when that is used up, of the stack's top; NO_REFERENCE at the end.
uint pending_next(inout Pending pending, inout uint top) {
    if (pending.count == 0u) {
        if (top == 0u) return NO_REFERENCE;
        pending = pending_unpack(stack[--top]);
    }
    uint reference = scene_node_child(pending.node, pending.slots & 3u);
    pending.slots >>= 2u;
    --pending.count;
    return reference;
}

// A ray on its way through the tree.
struct Traversal {
    Ray ray;
    RaySlabs slabs;
    RayShear shear;
    bool any_hit;     // The first hit is the end.
    Hit hit;          // The nearest so far; t is t_max where there is none.
    uint reference;   // To be visited next; NO_REFERENCE at the end.
    Pending pending;  // Siblings of `reference`,
    uint top;         // and how much of the stack is below them.
};

// Before the root, looking for hits with t in (0, t_max).
Traversal bvh_begin(Ray ray, float t_max, bool any_hit) {
    Pending nothing = Pending(0u, 0u, 0u);
    return Traversal(ray, ray_slabs(ray), ray_shear(ray.d), any_hit, Hit(t_max, 0u, vec2(0.0)), 0u, nothing, 0u);
}

bool bvh_ended(Traversal t) {
    return t.reference == NO_REFERENCE;
}

// So many nodes a ray may visit before those that have come to a leaf go on. Where lanes go together and none skips
// what others do, as on software Vulkan, fewer would mean more tests of leaves for few rays, and more would mean that
// most rays wait for the one that has furthest to go.
const uint NODES_PER_TURN = 4u;

// Takes a ray some way on; not one that has ended.
void bvh_advance(inout Traversal t) {
    // Go down, perhaps to a leaf.
    for (uint i = 0u; i < NODES_PER_TURN && (t.reference & BVH_LEAF_BIT) == 0u; ++i) {
        if (t.pending.count > 0u) stack[t.top++] = pending_pack(t.pending);
        t.pending = pending_children(t.reference, node_intersect(scene_node(t.reference), t.slabs, t.hit.t));
        t.reference = pending_next(t.pending, t.top);
    }
    if ((t.reference & BVH_LEAF_BIT) == 0u || t.reference == NO_REFERENCE) return;

    // Test the leaf's next primitive.
    uint count = (t.reference >> BVH_COUNT_SHIFT) & BVH_COUNT_MASK;
    float t_max = t.hit.t;
    if (count > 0u) {
        uint position = t.reference & BVH_FIRST_MASK;
        primitive_intersect(t.ray, t.shear, scene_primitive(position), position, t.hit);
    }
    if (t.any_hit && t.hit.t < t_max) {
        t.reference = NO_REFERENCE;
    } else if (count > 1u) {
        t.reference += 1u - (1u << BVH_COUNT_SHIFT);
    } else {
        t.reference = pending_next(t.pending, t.top);
    }
}

// The closest hit with t > 0; Hit::t is FLOAT_MAX where there is none.
Hit bvh_intersect(Ray ray) {
    Traversal t = bvh_begin(ray, FLOAT_MAX, false);
    while (!bvh_ended(t)) bvh_advance(t);
    return t.hit;
}

// True if any primitive meets the ray with t in (0, t_max).
bool bvh_occluded(Ray ray, float t_max) {
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
