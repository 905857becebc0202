// Record of a child of a node of the tree over lights, 2 words of uvec4: a sphere around all lights below it, their
// strength, and a cone around their normals. A node has LIGHT_TREE_WIDTH children in a row. Trails are the ways down to
// lights, four to a word. Behind the tree over the scene's lights come those over the lights of lamps.
//
//   0: centre.xyz, radius   1: strength, axis, cone, at
#ifndef SHARED_LIGHT_TREE_H
#define SHARED_LIGHT_TREE_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint LIGHT_TREE_WORDS = 2u;
const uint LIGHT_TRAILS_WORDS = 1u;  // Words of four trails.
const uint LIGHT_TREE_WIDTH = 4u;    // Children of a node.

// Maximum number of nodes on a way down a tree, that over all lights or that of a lamp. The trail of a light is a word
// with two bits a node: the child to take, the root's in the lowest bits.
const uint LIGHT_TREE_MAX_DEPTH = 16u;

// With this bit, `at` is the index of a light in the table of lights; without it, the index of a node.
const uint LIGHT_TREE_LEAF_BIT = 0x80000000u;

// An axis' word: its components times this, as signed whole numbers of 10 bits, x in the lowest.
const float LIGHT_TREE_AXIS = 511.0f;

// A cone's word: the sines of half its two angles, in units of 1 / LIGHT_TREE_SINE, and whether some light emits to
// both sides.
const uint LIGHT_TREE_SINE = 0x7FFFu;
const uint LIGHT_TREE_EMISSION_SHIFT = 15u;
const uint LIGHT_TREE_BOTH_SIDES = 0x40000000u;

struct LightTreeChild {
    vec3 centre;  // Of the sphere, in the frame of the scene, or in the space of a lamp's mesh.
    float radius;
    float strength;  // Sum of the maximum intensities of its lights; 1 for the whole tree. 0 if there is no such child.
    uint axis;
    uint cone;  // The maximum angles between the axis and a normal, and between a normal and light that is emitted.
    uint at;    // Index of a node, or of a light with LIGHT_TREE_LEAF_BIT.
};

#ifdef __cplusplus

inline std::array<uvec4, LIGHT_TREE_WORDS> pack(const LightTreeChild& c) {
    return {word(c.centre, floatBitsToUint(c.radius)), uvec4(floatBitsToUint(c.strength), c.axis, c.cone, c.at)};
}

}  // namespace candela
#else

LightTreeChild light_tree_unpack(uvec4 a, uvec4 b) {
    LightTreeChild c;
    c.centre = uintBitsToFloat(a.xyz);
    c.radius = uintBitsToFloat(a.w);
    c.strength = uintBitsToFloat(b.x);
    c.axis = b.y;
    c.cone = b.z;
    c.at = b.w;
    return c;
}

#endif

#endif
