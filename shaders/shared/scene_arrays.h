// The arrays of a scene, whose records are words of uvec4, and their buffers, each of which holds one array
// or several that change together. A buffer is a texel buffer or, if it is too long for one, lies in a
// storage buffer; a device may have few of either.
//
// scene_arrays.inc lists the arrays, scene_buffers.inc the buffers: both languages get a number ARRAY_NAME or
// BUFFER_NAME for each line, and each kernel a specialization constant SLOT_NAME for each buffer: the storage
// buffer in which it lies, or NO_SLOT.
#ifndef SHARED_SCENE_ARRAYS_H
#define SHARED_SCENE_ARRAYS_H

#include "shared/bvh_node.h"
#include "shared/light.h"
#include "shared/light_tree.h"
#include "shared/material.h"
#include "shared/primitive.h"
#include "shared/principled.h"
#include "shared/texture.h"

#ifdef __cplusplus
#include <iterator>
namespace candela {
#endif

// No storage buffer.
const uint NO_SLOT = 0xFFFFFFFFu;

// Storage buffers that every device has for the arrays: Vulkan promises four, and one is for counters.
const uint MIN_STORAGE_BUFFERS = 3u;

#define ARRAY(number, buffer, name, words) const uint ARRAY_##name = number;
#include "shared/scene_arrays.inc"
#undef ARRAY

#define BUFFER(number, name) const uint BUFFER_##name = number;
#include "shared/scene_buffers.inc"
#undef BUFFER

#ifdef __cplusplus

// The buffer of an array, its name in messages, and the length of its records.
struct SceneArray {
    uint number;
    uint buffer;
    const char* name;
    uint words;
};

#define ARRAY(number, buffer, name, words) {number, BUFFER_##buffer, #name, words},
inline constexpr SceneArray SCENE_ARRAYS[]{
#include "shared/scene_arrays.inc"
};
#undef ARRAY

inline constexpr uint ARRAY_COUNT = std::size(SCENE_ARRAYS);

#define BUFFER(number, name) (number),
inline constexpr uint BUFFERS[]{
#include "shared/scene_buffers.inc"
};
#undef BUFFER

inline constexpr uint BUFFER_COUNT = std::size(BUFFERS);

}  // namespace candela
#else

#define ARRAY(number, buffer, name, words) +1u
const uint ARRAY_COUNT = 0u
#include "shared/scene_arrays.inc"
    ;
#undef ARRAY

#endif

#endif
