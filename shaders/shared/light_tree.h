// Record of a child of a node of the tree over lights, 2 words of uvec4: the sphere around all lights below it, their
// strength, and the cone around their normals. A node is LIGHT_TREE_WIDTH of them in a row. And trails, the ways down
// to lights, four to a word.
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
const uint LIGHT_TRAILS_WORDS = 1u;  // Of four trails.
const uint LIGHT_TREE_WIDTH = 4u;    // Children of a node.

// No way down has more nodes, so that a word has room for two bits a node: a light's trail, whose lowest bits
// say which child of the root comes first.
const uint LIGHT_TREE_MAX_DEPTH = 16u;

// A child with this bit is the light at that place in the table of lights; one without it is a node.
const uint LIGHT_TREE_LEAF_BIT = 0x80000000u;

// An axis' word: its components, from the lowest bits on, times this, as whole numbers with a sign.
const float LIGHT_TREE_AXIS = 511.0f;

// A cone's word: the sines of half its two angles, each in units of 1 / LIGHT_TREE_SINE, and above them whether
// some light emits to both sides.
const uint LIGHT_TREE_SINE = 0x7FFFu;
const uint LIGHT_TREE_EMISSION_SHIFT = 15u;
const uint LIGHT_TREE_BOTH_SIDES = 0x40000000u;

struct LightTreeChild {
    vec3 centre;  // Of the sphere, in the frame of the scene.
    float radius;
    float strength;  // Sum of the greatest intensities of the lights; that of the whole tree is 1. 0: there is none.
    uint axis;
    uint cone;  // All normals are within the first angle around the axis; what leaves a light is within the second
                // angle around its normal.
    uint at;    // Index of a node, or a light with LIGHT_TREE_LEAF_BIT.
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
