// The arrays of a scene, whose records are words of uvec4, and where a kernel finds them: each is a texel
// buffer or, if it is too long for one, lies in a storage buffer, of which a device may have few.
//
// scene_arrays.inc lists them: both languages get a number ARRAY_NAME for each line, and each kernel a
// specialization constant SLOT_NAME, the storage buffer that holds the array, or NO_SLOT.
#ifndef SHARED_SCENE_ARRAYS_H
#define SHARED_SCENE_ARRAYS_H

#include "shared/bvh_node.h"
#include "shared/light.h"
#include "shared/material.h"
#include "shared/primitive.h"
#include "shared/principled.h"
#include "shared/texture.h"

#ifdef __cplusplus
#include <iterator>
namespace candela {
#endif

// Stands for no storage buffer.
const uint NO_SLOT = 0xFFFFFFFFu;

// Storage buffers that every device has for the arrays: Vulkan promises four, and one is for counters.
const uint LEAST_STORAGE_BUFFERS = 3u;

#define ARRAY(number, name, words) const uint ARRAY_##name = number;
#include "shared/scene_arrays.inc"
#undef ARRAY

#ifdef __cplusplus

// What messages call an array, and the length of its records.
struct SceneArray {
    uint number;
    const char* name;
    uint words;
};

#define ARRAY(number, name, words) {number, #name, words},
inline constexpr SceneArray SCENE_ARRAYS[]{
#include "shared/scene_arrays.inc"
};
#undef ARRAY

inline constexpr uint ARRAY_COUNT = std::size(SCENE_ARRAYS);

}  // namespace candela
#else

#define ARRAY(number, name, words) +1u
const uint ARRAY_COUNT = 0u
#include "shared/scene_arrays.inc"
    ;
#undef ARRAY

#endif

#endif
