// See scene_buffers.h.
#include "render/scene_buffers.h"

#include <array>
#include <span>
#include <string>

#include "base/error.h"

namespace candela {
namespace {

constexpr std::array<const char*, SCENE_ARRAYS> ARRAY_NAMES{"nodes", "primitives", "tables"};
static_assert(BINDING_NODES == 0 && BINDING_PRIMITIVES == 1 && BINDING_TABLES == 2);

// By BINDING_*.
std::array<std::span<const uvec4>, SCENE_ARRAYS> arrays_of(const GpuScene& scene) {
    return {scene.nodes, scene.primitives, scene.tables};
}

bool is_storage(uint32_t storage_arrays, uint32_t array) {
    return (storage_arrays >> array & 1) != 0;
}

// Texel buffers wherever they hold the array: on a CPU they are several times faster, on a GPU no slower.
bool needs_storage(const vk::Device& device, const char* name, uint64_t texels) {
    const uint64_t bytes = texels * sizeof(uvec4);
    const vk::DeviceLimits& limits = device.limits();
    if (texels <= limits.max_texel_buffer_elements) return false;
    if (bytes <= limits.max_storage_buffer_range) return true;
    throw Error("the array of the scene's " + std::string(name) + " needs " + std::to_string(texels) +
                    " texels (" + std::to_string(bytes) + " bytes), but " + device.info().name +
                    " allows maxTexelBufferElements = " + std::to_string(limits.max_texel_buffer_elements) +
                    " and maxStorageBufferRange = " + std::to_string(limits.max_storage_buffer_range) +
                    " bytes; use a smaller scene, or another device (candela devices lists them)",
                ExitCode::out_of_memory);
}

}  // namespace

uint32_t choose_storage_arrays(const vk::Device& device, const GpuScene& scene, SceneAccess wanted) {
    if (wanted == SceneAccess::texel_buffers) return 0;
    if (wanted == SceneAccess::storage_buffers) return ALL_STORAGE_ARRAYS;
    const auto arrays = arrays_of(scene);
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < SCENE_ARRAYS; ++i)
        chosen |= uint32_t{needs_storage(device, ARRAY_NAMES[i], arrays[i].size())} << i;
    return chosen;
}

SceneBuffers::SceneBuffers(const vk::Device& device, const GpuScene& scene, const Parameters& parameters,
                           uint32_t storage_arrays)
    : storage_arrays_(storage_arrays),
      unread_texels_(device, sizeof(uvec4), vk::BufferUsage::texel, "unread texels"),
      unread_storage_(device, sizeof(uvec4), vk::BufferUsage::storage, "unread words"),
      parameters_(device, PARAMETERS_WORDS * sizeof(uvec4), vk::BufferUsage::uniform, "parameters") {
    const auto arrays = arrays_of(scene);
    for (uint32_t i = 0; i < SCENE_ARRAYS; ++i) {
        const auto usage = is_storage(storage_arrays, i) ? vk::BufferUsage::storage : vk::BufferUsage::texel;
        arrays_.emplace_back(device, arrays[i].size_bytes(), usage, ARRAY_NAMES[i]);
        arrays_.back().upload(std::as_bytes(arrays[i]));
    }
    set(parameters);
}

void SceneBuffers::set(const Parameters& parameters) {
    const auto words = pack(parameters);
    parameters_.upload(std::as_bytes(std::span(words)));
}

std::vector<vk::Binding> SceneBuffers::bindings() {
    std::vector<vk::Binding> bindings{{BINDING_PARAMETERS, vk::BindingType::uniform_buffer}};
    for (uint32_t i = 0; i < SCENE_ARRAYS; ++i) {
        bindings.push_back({i, vk::BindingType::texel_buffer});
        bindings.push_back({BINDING_STORAGE + i, vk::BindingType::storage_buffer});
    }
    return bindings;
}

void SceneBuffers::bind_to(vk::Kernel& kernel) const {
    for (uint32_t i = 0; i < SCENE_ARRAYS; ++i) {
        const bool storage = is_storage(storage_arrays_, i);
        kernel.bind(i, storage ? unread_texels_ : arrays_[i]);
        kernel.bind(BINDING_STORAGE + i, storage ? arrays_[i] : unread_storage_);
    }
    kernel.bind(BINDING_PARAMETERS, parameters_);
}

}  // namespace candela
