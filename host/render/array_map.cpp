// See array_map.h.
#include "render/array_map.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace candela {
namespace {

// The storage buffers that the scene may use: a kernel has one more, for counters or results. MoltenVK takes
// the length of an array of buffers from the default of its constant (MoltenVK issue 1421).
uint32_t available_buffers(const vk::DeviceInfo& device) {
    if (device.driver_id == VK_DRIVER_ID_MOLTENVK) return MIN_STORAGE_BUFFERS;
    return device.limits.max_per_stage_descriptor_storage_buffers - 1;
}

// If all of them are texel buffers, a probe has one more for its items, within the 16 that Vulkan promises.
static_assert(BUFFER_COUNT + 1 <= 16);

// Words of each of the scene's buffers.
std::array<uint64_t, BUFFER_COUNT> buffer_sizes(const GpuScene& scene) {
    std::array<uint64_t, BUFFER_COUNT> sizes{};
    for (const SceneArray& array : SCENE_ARRAYS)
        sizes[array.buffer] += scene.arrays[array.number].size();
    return sizes;
}

[[noreturn]] void fail_too_long(const vk::DeviceInfo& device, const std::string& arrays, uint64_t bytes) {
    throw Error(arrays + " " + std::to_string(bytes / sizeof(uvec4)) + " texels (" + std::to_string(bytes) +
                    " bytes), but " + device.name + " allows maxTexelBufferElements = " +
                    std::to_string(device.limits.max_texel_buffer_elements) +
                    " and maxStorageBufferRange = " + std::to_string(device.limits.max_storage_buffer_range) +
                    " bytes; use a smaller scene, or another device (candela devices lists them)",
                ErrorKind::out_of_memory);
}

// Throws Error if these buffers together are too long for one storage buffer.
void check_range(const vk::DeviceInfo& device, const GpuScene& scene, std::span<const uint32_t> buffers) {
    uint64_t bytes = 0;
    bool one = true;
    std::string names;
    for (const uint32_t buffer : buffers) {
        for (const SceneArray& array : SCENE_ARRAYS) {
            if (array.buffer != buffer || scene.arrays[array.number].empty()) continue;
            bytes += scene.arrays[array.number].size() * sizeof(uvec4);
            one = names.empty();
            names += (one ? "" : ", ") + to_text(array);
        }
    }
    if (bytes <= device.limits.max_storage_buffer_range) return;
    fail_too_long(device,
                  (one ? "the scene's array " + names + " needs" : "the scene's arrays " + names + " need"),
                  bytes);
}

}  // namespace

ArrayMap map_arrays(const vk::DeviceInfo& device, const GpuScene& scene, SceneAccess wanted) {
    const std::array<uint64_t, BUFFER_COUNT> sizes = buffer_sizes(scene);
    std::vector<uint32_t> stored;
    for (uint32_t i = 0; i < BUFFER_COUNT; ++i) {
        const bool too_long = sizes[i] > device.limits.max_texel_buffer_elements;
        if (wanted == SceneAccess::storage_buffers || (wanted == SceneAccess::automatic && too_long))
            stored.push_back(i);
    }
    std::ranges::stable_sort(stored, std::greater(), [&](uint32_t i) { return sizes[i]; });

    ArrayMap map;
    map.slots.fill(NO_SLOT);
    const uint32_t available = available_buffers(device);
    const bool shared = stored.size() > available;
    const size_t alone = shared ? available - 1 : stored.size();
    std::array<uint64_t, BUFFER_COUNT> ends{};  // Ends of the arrays so far, in their buffers.
    uint64_t shared_end = 0;
    for (size_t i = 0; i < stored.size(); ++i) {
        map.slots[stored[i]] = uint32_t(std::min(i, alone));
        if (i < alone) {
            check_range(device, scene, {&stored[i], 1});
        } else {
            ends[stored[i]] = shared_end;
            shared_end += sizes[stored[i]];
        }
    }
    for (const SceneArray& array : SCENE_ARRAYS) {
        map.starts[array.number] = uint32_t(ends[array.buffer]);
        ends[array.buffer] += scene.arrays[array.number].size();
    }
    if (shared) {
        map.shared_slot = uint32_t(alone);
        check_range(device, scene, std::span(stored).subspan(alone));
    }
    map.storage_buffers = uint32_t(alone) + uint32_t{shared};
    if (device.driver_id == VK_DRIVER_ID_MOLTENVK) map.storage_buffers = MIN_STORAGE_BUFFERS;
    map.storage_buffers = std::max(map.storage_buffers, 1u);
    return map;
}

void set_arrays(KernelConstants& constants, const ArrayMap& map) {
    constants[CONSTANT_STORAGE_BUFFERS] = map.storage_buffers;
    constants[CONSTANT_SHARED_SLOT] = map.shared_slot;
    std::ranges::copy(map.slots, &constants[CONSTANT_SLOT_NODES]);
}

std::string to_text(const SceneArray& array) {
    std::string text = array.name;
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

const char* to_text(const ArrayMap& map) {
    const auto stored = std::ranges::count_if(map.slots, [](uint32_t slot) { return slot != NO_SLOT; });
    return stored == 0 ? "texel" : stored == BUFFER_COUNT ? "storage" : "mixed";
}

}  // namespace candela
