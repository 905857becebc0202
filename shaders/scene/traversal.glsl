// Rays against the scene's BVH: the closest hit, and whether there is any.
#ifndef SCENE_TRAVERSAL_GLSL
#define SCENE_TRAVERSAL_GLSL

#include "scene/list.glsl"
#include "scene/node.glsl"
#include "scene/opacity.glsl"
#include "scene/scene_data.glsl"
#include "scene/stack.glsl"

// Must run before an invocation's first ray.
void bvh_prepare() {
    list_prepare();
}

// Stands for no node.
const uint NODE_NONE = 0xFFFFFFFFu;

// The state of a ray that traverses the tree.
struct Traversal {
    Ray ray;        // In the space of the nodes that it visits: the scene's, or that of an instance's mesh.
    vec3 inv_d;  // reciprocals(ray.d)
    RayShear shear;
    bool any_hit;     // The first hit ends the traversal.
    Hit hit;          // The nearest so far.
    uint node;        // To be visited next;
    uint pending;     // then its siblings; those further up are on the stack.
    uint leaves;      // To be tested before `node`; bit i: the primitive i places after
    uint first_leaf;  // this position in leaf order.
    Candidate candidate;  // For bvh_decide.
    Ray outside;     // In the frame of the scene.
    uint instance;   // That the ray is in, or NO_INSTANCE,
    uint root;       // and the root of its mesh, behind which lie all nodes of the mesh; 0 outside.
    bool entering;   // The ray is in an instance, but not yet in its space.
};

// A traversal at the root that looks for hits with t in (0, t_max). bvh_prepare comes first.
Traversal bvh_begin(Ray ray, float t_max, bool any_hit) {
    stack[0] = PENDING_NONE;
    vec3 inv_d = reciprocals(ray.d);
    return Traversal(ray, inv_d, ray_shear(ray.d, inv_d), any_hit, hit_none(t_max), 0u, PENDING_NONE, 0u, 0u,
                     candidate_none(), ray, NO_INSTANCE, 0u, false);
}

// Ends a traversal: no node is left to visit, no leaf to test.
void bvh_end(inout Traversal t) {
    t.node = NODE_NONE;
    t.leaves = 0u;
}

// Continues in another space.
void change_space(inout Traversal t, Ray ray) {
    t.ray = ray;
    t.inv_d = reciprocals(ray.d);
    t.shear = ray_shear(ray.d, t.inv_d);
}

// Whether the next node lies in another space than the ray.
bool changes_space(Traversal t) {
    return INSTANCED && (t.entering || t.node < t.root);
}

// Leaves the instance that the ray is in if the next node lies outside: in the frame of the scene, whose nodes precede
// those of meshes.
void leave_instance(inout Traversal t) {
    if (t.entering || t.leaves != 0u || !changes_space(t)) return;
    change_space(t, t.outside);
    t.instance = NO_INSTANCE;
    t.root = 0u;
}

// Goes on to the root of the mesh of the instance that the ray enters, if it enters one.
void enter_instance(inout Traversal t) {
    if (!t.entering) return;
    Instance instance = scene_instance(t.instance);
    change_space(t, ray_to_mesh(instance, t.outside));
    t.node = t.root = instance.root;
    t.entering = false;
}

// The traversal waits for bvh_decide.
bool bvh_waits(Traversal t) {
    return HAS_OPACITY && is_hit(t.candidate.hit);
}

bool bvh_ended(Traversal t) {
    return t.node == NODE_NONE && t.leaves == 0u && !bvh_waits(t);
}

// Decides whether the hit for which the traversal waits, if it does, stops the ray.
void bvh_decide(inout Traversal t) {
    if (!bvh_waits(t)) return;
    decide(t.ray, t.shear, t.hit, t.candidate);
    if (t.any_hit && is_hit(t.hit)) bvh_end(t);
}

// Traverses to the next leaves and tests them, up to a hit that must wait for bvh_decide. Does nothing if the traversal
// has ended.
//
// Leaves are tested as soon as their boxes are hit, and never wait on the stack, so that one word per level is enough.
// On software Vulkan, neighbouring lanes wait for each other at the end of either loop. So what changes the space stands
// outside of them.
void bvh_advance(inout Traversal t) {
    if (LIST > 0u) {
        list_intersect(t.ray, t.shear, t.hit);
        bvh_end(t);
        return;
    }

    if (INSTANCED) leave_instance(t);

    // Go to the nearest child, else to the next sibling, else up.
    while (t.leaves == 0u && t.node != NODE_NONE && !changes_space(t)) {
        // What is next if this node has no child to visit.
        bool siblings = pending_any(t.pending);
        uint next = mix(stack[0], t.pending, siblings);
        uint next_node = mix(NODE_NONE, pending_node(next, pending_first(next)), pending_any(next));

        BvhNode node = scene_node(t.node);
        NodeHits met = node_intersect(node, t.ray, t.inv_d, t.hit.t, INSTANCED && t.root == 0u);
        t.leaves = met.leaves;
        t.first_leaf = bvh_first_primitive(node.children);
        bool down = met.nodes != 0u;
        uint others = met.nodes & ~(1u << met.nearest);
        uint child = node.children.x + met.nearest;
        if (INSTANCED && is_instance(node)) {
            t.leaves = others = 0u;
            down = t.entering = true;
            child = t.instance = t.node;
        }
        stack_move(!down && !siblings, down && siblings, t.pending);
        t.pending = mix(pending_rest(next), node.children.x | others << PENDING_SHIFT, down);
        t.node = mix(next_node, child, down);
    }

    // Test the leaves.
    while (t.leaves != 0u && !bvh_waits(t)) {
        uint position = t.first_leaf + uint(findLSB(t.leaves));
        t.leaves &= t.leaves - 1u;
        meet(position, primitive_hit(t.ray, t.shear, scene_primitive(position), position, t.instance), t.hit, t.candidate);
    }
    if (INSTANCED) enter_instance(t);
    if (t.any_hit && is_hit(t.hit)) bvh_end(t);
}

// Advances a traversal until it has ended.
void bvh_finish(inout Traversal t) {
    while (!bvh_ended(t)) {
        bvh_advance(t);
        bvh_decide(t);
    }
}

// The closest hit with t > 0, if there is any.
Hit bvh_intersect(Ray ray) {
    bvh_prepare();
    Traversal t = bvh_begin(ray, FLOAT_MAX, false);
    bvh_finish(t);
    return t.hit;
}

// True if the ray hits any primitive with t in (0, t_max).
bool bvh_occluded(Ray ray, float t_max) {
    bvh_prepare();
    Traversal t = bvh_begin(ray, t_max, true);
    bvh_finish(t);
    return is_hit(t.hit);
}

// The place of the triangle, sphere or disk in the scene's own order; 0 for no hit.
uint hit_id(Hit hit) {
    if (!is_hit(hit)) return 0u;
    uvec2 id = hit_surface(hit).id;
    return hit_second(hit) ? id.y : id.x;
}

#endif
