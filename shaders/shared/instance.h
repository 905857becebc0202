// Record of an instance: a mesh that is shown once more, elsewhere. It has the place of a node in the array
// of nodes, 4 words of uvec4; the lowest byte of a node's first w is never zero.
//
//   0: to_mesh row 0, root << 8              2: to_mesh row 2, first_id
//   1: to_mesh row 1, material | error       3: centre.xyz, lamp
//
// An instance has one child, the root of its mesh's tree, whose nodes and primitives lie in the mesh's space.
// A ray goes there with its parameter t unchanged: the point p of the scene's frame is the point to_mesh (p -
// centre) of the mesh's space.
#ifndef SHARED_INSTANCE_H
#define SHARED_INSTANCE_H

#include "shared/bvh_node.h"
#include "shared/primitive.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

// No instance, i.e. the frame of the scene: the first node is always the root.
const uint NO_INSTANCE = 0u;

// How far a ray in a mesh's space may be off the ray in the frame of the scene, per length of its origin
// there: a rounding of the difference to the centre, and three each of origin and direction for products that
// MAX_INSTANCE_CONDITION bounds. (2^-17 is 128 roundings.)
const float INSTANCE_RAY_ERROR = 1.0 / 131072.0;

// The greatest sum of a row of |to_scene| |to_mesh|, absolute values of the matrices' elements, that an
// instance may have. It bounds the growth of rounding on the way back from the mesh's space, and is at most 3
// for turns and scales along the mesh's axes.
const float MAX_INSTANCE_CONDITION = 16.0;

struct Instance {
    vec3 to_mesh[3];  // Rows.
    vec3 centre;      // Origin of the mesh's space, in the frame of the scene.
    uint root;        // Index of the root of the mesh's tree, among all nodes.
    uint first_id;    // Added to the ids of the mesh's surfaces, modulo 2^32.
    uint material;    // Replaces the material of the mesh's surfaces.
    float error;      // Added to a surface's error for rays, in the frame of the scene: 0 or a power of two.
    uint lamp;        // Its place in the table of lights, if some surface of the mesh has a light.
};

#ifdef __cplusplus

inline Instance instance_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d);
inline bool is_instance(BvhNode node);

inline PackedBvhNode pack(const Instance& i) {
    return {word(i.to_mesh[0], i.root << 8u), word(i.to_mesh[1], i.material | floatBitsToUint(i.error)),
            word(i.to_mesh[2], i.first_id), word(i.centre, i.lamp)};
}

#endif

// Decodes a record, in both languages.
Instance instance_unpack(uvec4 a, uvec4 b, uvec4 c, uvec4 d) {
    Instance i;
    i.to_mesh[0] = uintBitsToFloat(uvec3(a));
    i.to_mesh[1] = uintBitsToFloat(uvec3(b));
    i.to_mesh[2] = uintBitsToFloat(uvec3(c));
    i.centre = uintBitsToFloat(uvec3(d));
    i.root = a.w >> 8u;
    i.material = b.w & (MAX_MATERIALS - 1u);
    i.error = uintBitsToFloat(b.w & SURFACE_ERROR_BITS);
    i.first_id = c.w;
    i.lamp = d.w;
    return i;
}

// Whether a node's place holds the record of an instance.
bool is_instance(BvhNode node) {
    return node.scale.x == 0.0f;
}

#ifdef __cplusplus
}  // namespace candela
#endif

#endif
