// The stack of a ray on its way through the tree.
#ifndef SCENE_STACK_GLSL
#define SCENE_STACK_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "shared/kernel_constants.h"

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

#endif
