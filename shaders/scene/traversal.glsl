// Rays against the scene's BVH: the closest hit, or whether there is any hit.
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

// No node.
const uint NODE_NONE = 0xFFFFFFFFu;

// The state of a ray that traverses the tree.
struct Traversal {
    Ray ray;     // In the space of the nodes that it visits: the scene's, or that of an instance's mesh.
    vec3 inv_d;  // reciprocals(ray.d)
    RayShear shear;
    bool any_hit;         // The first hit that stops the ray ends the traversal: that of a shadow ray.
    Hit hit;              // The nearest so far.
    uint node;            // The next node to be visited.
    uint pending;         // Its siblings, which come after it; those further up are on the stack.
    uint leaves;          // Leaves to be tested before `node`; bit i: primitive first_leaf + i.
    uint first_leaf;      // Position in leaf order.
    Candidate candidate;  // For bvh_decide.
    Ray outside;          // In the frame of the scene.
    uint instance;        // The instance that the ray is in, or NO_INSTANCE.
    uint root;            // The root of its mesh, followed by all nodes of the mesh; 0 outside instances.
    bool of_camera;       // It is a camera ray, for which hidden surfaces are not there; only if HAS_HIDDEN.
    bool alone;           // Only catchers and what emits are there; only if HAS_CATCHERS.
    uint depth;           // Optical depth of what the ray has passed, in parts; only if HAS_OPACITY and any_hit.
    uint iterations;      // Of loops, for this ray; only if VOLUMETRIC.
};

// A traversal at the root that looks for hits with t in (0, t_max). bvh_prepare comes first.
Traversal bvh_begin(Ray ray, float t_max, bool any_hit) {
    stack[0] = PENDING_NONE;
    vec3 inv_d = reciprocals(ray.d);
    return Traversal(ray, inv_d, ray_shear(ray.d, inv_d), any_hit, hit_none(t_max), 0u, PENDING_NONE, 0u, 0u,
                     candidate_none(), ray, NO_INSTANCE, 0u, false, false, 0u, 0u);
}

// Whether the surface also belongs to the scene without what is seen before catchers: it is one, or it emits.
bool stays_alone(Surface surface) {
    return surface.light != NO_LIGHT || scene_material_textures(surface.material).catcher != CATCHER_NONE;
}

// Ends a traversal: no node is left to visit, no leaf to test.
void bvh_end(inout Traversal t) {
    t.node = NODE_NONE;
    t.leaves = 0u;
}

// With instances, bvh_advance visits at most this many nodes: on software Vulkan, lanes that have found leaves wait for
// the others, which may have to go as far as the next instance.
const uint NODES_PER_TURN = 7u;

// Returns the ray to the frame of the scene if the next node lies there, before the nodes of all meshes.
void leave_instance(inout Traversal t) {
    if (t.node < t.root) {
        t.ray = t.outside;
        t.instance = NO_INSTANCE;
        t.root = 0u;
    }
    t.inv_d = reciprocals(t.ray.d);  // For enter_instance, too.
}

// Brings the ray into the space of an instance if its record, of these words, lies in the node's place; the root of its
// mesh is then the only child. On software Vulkan every lane computes with the words, and would be a hundred times
// slower for denormal numbers, which a node's words may be.
void enter_instance(inout Traversal t, BvhNode node, NodeWords words, inout bool down, inout uint rest,
                    inout uint child) {
    uint keep = is_instance(node) ? 0xFFFFFFFFu : 0u;
    Instance instance = instance_unpack(words.a & keep, words.b & keep, words.c & keep, words.d & keep);
    if (!is_instance(node)) return;
    t.ray = ray_to_mesh(instance, t.outside);
    t.instance = t.node;
    t.root = instance.root;
    t.leaves = 0u;
    down = true;
    rest = PENDING_NONE;
    child = instance.root;
}

// The traversal waits for bvh_decide.
bool bvh_waits(Traversal t) {
    return HAS_PASSABLE && is_hit(t.candidate.hit);
}

bool bvh_ended(Traversal t) {
    return t.node == NODE_NONE && t.leaves == 0u && !bvh_waits(t);
}

// Decides whether the hit for which the traversal waits, if it does, stops the ray.
void bvh_decide(inout Traversal t) {
    if (!bvh_waits(t)) return;
    decide(t.ray, t.shear, t.any_hit, t.of_camera, t.hit, t.candidate, t.depth);
    if (t.any_hit && is_hit(t.hit)) bvh_end(t);
}

// Traverses to the next leaves and tests them, up to a hit that must wait for bvh_decide. Does nothing if the traversal
// has ended.
//
// Leaves are tested as soon as their boxes are hit, and never wait on the stack, so that one word per level is enough.
// On software Vulkan, neighbouring lanes wait for each other at the end of either loop. So a ray changes its space
// within the loop over nodes, where every lane pays for it, but none waits.
void bvh_advance(inout Traversal t) {
    if (LIST > 0u) {
        list_intersect(t.ray, t.shear, t.hit);
        bvh_end(t);
        return;
    }

    if (VOLUMETRIC) t.iterations += 3u;  // The caller's, and the last ones of both loops.
    // Go to the nearest child, else to the next sibling, else up.
    for (uint k = 0u; t.leaves == 0u && t.node != NODE_NONE && (!INSTANCED || k < NODES_PER_TURN); ++k) {
        if (INSTANCED) leave_instance(t);
        if (VOLUMETRIC) ++t.iterations;

        // The next node if this one has no child to visit.
        bool siblings = pending_any(t.pending);
        uint next = mix(stack[0], t.pending, siblings);
        uint next_node = mix(NODE_NONE, pending_node(next, pending_first(next)), pending_any(next));

        NodeWords words = scene_node_words(t.node);
        BvhNode node = bvh_node_unpack(words.a, words.b, words.c, words.d);
        NodeHits met = node_intersect(node, t.ray, t.inv_d, t.hit.t, INSTANCED && t.root == 0u);
        t.leaves = met.leaves;
        t.first_leaf = bvh_first_primitive(node.children);
        bool down = met.nodes != 0u;
        uint others = met.nodes & ~(1u << met.nearest);
        uint child = node.children.x + met.nearest;
        uint rest = node.children.x | others << PENDING_SHIFT;
        if (INSTANCED) {
            if (node_descends(node, t.ray)) rest |= PENDING_DESCENDS;
            enter_instance(t, node, words, down, rest, child);
        }
        stack_move(!down && !siblings, down && siblings, t.pending);
        t.pending = mix(pending_rest(next), rest, down);
        t.node = mix(next_node, child, down);
    }
    if (INSTANCED) t.shear = ray_shear(t.ray.d, t.inv_d);

    // Test the leaves.
    while (t.leaves != 0u && !bvh_waits(t)) {
        uint position = t.first_leaf + uint(findLSB(t.leaves));
        t.leaves &= t.leaves - 1u;
        if (VOLUMETRIC) ++t.iterations;
        if (HAS_CATCHERS && t.alone && !stays_alone(scene_surface(position))) continue;
        Hit first = primitive_hit(t.ray, t.shear, scene_primitive(position), position, t.instance);
        meet(position, first, t.hit, t.candidate);
    }
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

// What the camera sees along the ray: the closest hit with t > 0 of what is not hidden, if there is any.
Hit bvh_seen(Ray ray) {
    bvh_prepare();
    Traversal t = bvh_begin(ray, FLOAT_MAX, false);
    t.of_camera = true;
    bvh_finish(t);
    return t.hit;
}

// True if the ray hits any primitive with t in (0, t_max) that is opaque there.
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
