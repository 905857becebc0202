// See scene_buffers.h.
#include "render/scene_buffers.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "vk/transfer.h"

namespace candela {
namespace {

// The words that follow the parameters in their buffer: the arrays' starts, four to a word.
constexpr uint32_t STARTS_WORDS = (ARRAY_COUNT + 3) / 4;

// Words of each storage buffer.
std::vector<size_t> storage_sizes(const GpuScene& scene, const ArrayMap& map) {
    std::vector<size_t> sizes(map.storage_buffers);
    for (uint32_t i = 0; i < ARRAY_COUNT; ++i) {
        if (map.slots[i] != NO_SLOT)
            sizes[map.slots[i]] = std::max(sizes[map.slots[i]], map.starts[i] + scene.arrays[i].size());
    }
    return sizes;
}

}  // namespace

// All bindings of a kernel must be bound, so that those which it does not read get buffers of one word.
SceneBuffers::SceneBuffers(const vk::Device& device, const GpuScene& scene, const Parameters& parameters,
                           const ArrayMap& map)
    : map_(map),
      parameters_(device, (PARAMETERS_WORDS + STARTS_WORDS) * sizeof(uvec4), vk::BufferUsage::uniform,
                  "parameters") {
    for (const size_t words : storage_sizes(scene, map))
        storage_.emplace_back(device, words * sizeof(uvec4), vk::BufferUsage::storage,
                              "storage " + std::to_string(storage_.size()));
    std::array<uvec4, STARTS_WORDS> starts{};
    for (const SceneArray& array : SCENE_ARRAYS) {
        const uint32_t i = array.number;
        const auto bytes = std::as_bytes(std::span(scene.arrays[i]));
        const bool texel = map.slots[i] == NO_SLOT;
        texels_.emplace_back(device, texel ? bytes.size() : 0, vk::BufferUsage::texel, to_text(array));
        if (texel) {
            vk::upload(texels_.back(), bytes);
        } else {
            vk::upload(storage_[map.slots[i]], bytes, map.starts[i] * sizeof(uvec4));
        }
        starts[i / 4][int(i % 4)] = map.starts[i];
    }
    vk::upload(parameters_, std::as_bytes(std::span(starts)), PARAMETERS_WORDS * sizeof(uvec4));
    set(parameters);
}

void SceneBuffers::set(const Parameters& parameters) {
    const auto words = pack(parameters);
    vk::upload(parameters_, std::as_bytes(std::span(words)));
}

std::vector<vk::Binding> SceneBuffers::bindings(const KernelConstants& constants) {
    std::vector<vk::Binding> bindings{
        {BINDING_STORAGE, vk::BindingType::storage_buffer, constants[CONSTANT_STORAGE_BUFFERS]},
        {BINDING_PARAMETERS, vk::BindingType::uniform_buffer}};
    for (const SceneArray& array : SCENE_ARRAYS)
        bindings.push_back({array.number, vk::BindingType::texel_buffer});
    return bindings;
}

void SceneBuffers::bind_to(vk::Kernel& kernel) const {
    for (const SceneArray& array : SCENE_ARRAYS)
        kernel.bind(array.number, texels_[array.number]);
    for (uint32_t slot = 0; slot < storage_.size(); ++slot)
        kernel.bind(BINDING_STORAGE, storage_[slot], slot);
    kernel.bind(BINDING_PARAMETERS, parameters_);
}

}  // namespace candela
