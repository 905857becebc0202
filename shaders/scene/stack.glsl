// The stack of a ray that traverses the tree.
#ifndef SCENE_STACK_GLSL
#define SCENE_STACK_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "shared/kernel_constants.h"

// `pending`: the children of a node that are nodes and still to be visited. Bit PENDING_SHIFT + i: child i; the bits
// below: the index of the first child.
const uint PENDING_SHIFT = 24u;
const uint PENDING_NONE = 0u;
// With instances, the highest child comes first.
const uint PENDING_DESCENDS = 0x80000000u;

// The bits of the pending children.
uint pending_children(uint pending) {
    return INSTANCED ? pending >> PENDING_SHIFT & 127u : pending >> PENDING_SHIFT;
}

bool pending_any(uint pending) {
    return pending_children(pending) != 0u;
}

// The pending child to be visited first; undefined if there is none.
uint pending_first(uint pending) {
    uint children = pending_children(pending);
    if (!INSTANCED) return uint(findLSB(children));
    return uint(mix(findLSB(children), findMSB(children), (pending & PENDING_DESCENDS) != 0u));
}

// The node's index of a pending child.
uint pending_node(uint pending, uint child) {
    return (pending & (BVH_MAX_NODES - 1u)) + child;
}

// `pending` without the child to be visited first, if it has any.
uint pending_rest(uint pending) {
    if (!INSTANCED) return pending & (pending - (1u << PENDING_SHIFT));
    return pending & ~(1u << PENDING_SHIFT << (pending_first(pending) & 31u));
}

// The stack of bvh_advance, its top at 0: the pending children at each level above the current node, and PENDING_NONE
// below them. The root has no siblings, and the siblings of the node to be visited are not here. The whole stack moves
// with every push and pop, so that no index depends on the ray and the array becomes registers: on software Vulkan,
// storing to an indexed array is slower than moving ten words. (The loop counters are signed, or lavapipe 22.3 would
// not unroll the loops.) As a function's argument, the stack would be copied.
const int STACK_WORDS = BVH_DEPTH > 1u ? int(BVH_DEPTH) - 1 : 1;
uint stack[STACK_WORDS];

// Pops the top if `pop`, or pushes `pending` if `push`. It selects instead of branching, or lavapipe 22.3 would move
// every word twice.
void stack_move(bool pop, bool push, uint pending) {
    [[unroll]] for (int k = 0; k < STACK_WORDS - 1; ++k) stack[k] = mix(stack[k], stack[k + 1], pop);
    [[unroll]] for (int k = STACK_WORDS - 1; k > 0; --k) stack[k] = mix(stack[k], stack[k - 1], push);
    stack[0] = mix(stack[0], pending, push);
}

#endif
