// Where a kernel finds the arrays of a scene: the values of the constants SLOT_*, SHARED_SLOT and
// STORAGE_BUFFERS.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "gpu_scene/gpu_scene.h"
#include "shared/kernel_constants.h"
#include "shared/scene_arrays.h"
#include "vk/device_info.h"

namespace candela {

// How kernels read the arrays of a scene. Every way gives the same bits.
enum class SceneAccess { automatic, texel_buffers, storage_buffers };

struct ArrayMap {
    // For each of the scene's buffers, its storage buffer, or NO_SLOT for a texel buffer.
    std::array<uint32_t, BUFFER_COUNT> slots;
    std::array<uint32_t, ARRAY_COUNT> starts{};  // In words, within the texel or storage buffer.
    uint32_t shared_slot = NO_SLOT;  // The storage buffer that several of the scene's buffers share.
    uint32_t storage_buffers = 1;    // Number that a kernel declares, used or not.

    bool operator==(const ArrayMap&) const = default;
};

// Maps all buffers to texel buffers or all to storage buffers, as wanted; for `automatic`, maps only buffers
// that are too long for a texel buffer to storage buffers. Each gets its own storage buffer if the device
// allows that many; otherwise the longest do, and the others share the last one. Throws Error (out_of_memory)
// that names the arrays and the device's limits if a buffer would be too long.
ArrayMap map_arrays(const vk::DeviceInfo& device, const GpuScene& scene, SceneAccess wanted);

// Sets the kernel's constants.
void set_arrays(KernelConstants& constants, const ArrayMap& map);

// "texel", "storage" or, where there are both, "mixed".
const char* to_text(const ArrayMap& map);

// The name of an array for people and programs, such as "light_alias".
std::string to_text(const SceneArray& array);

}  // namespace candela
