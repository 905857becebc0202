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

// The contents of the device's buffers: bytes of each texel buffer, one for each of the scene's buffers, and
// of each storage buffer.
struct Sizes {
    std::array<uint64_t, BUFFER_COUNT> texel{};
    std::vector<uint64_t> storage;
};

Sizes device_sizes(const GpuScene& scene, const ArrayMap& map) {
    Sizes sizes{.storage = std::vector<uint64_t>(map.storage_buffers)};
    for (const SceneArray& array : SCENE_ARRAYS) {
        const uint32_t slot = map.slots[array.buffer];
        uint64_t& size = slot == NO_SLOT ? sizes.texel[array.buffer] : sizes.storage[slot];
        const uint64_t end = map.starts[array.number] + scene.arrays[array.number].size();
        size = std::max(size, end * sizeof(uvec4));
    }
    return sizes;
}

// Makes those buffers anew, by make(bytes, i), that have another size now. Returns which these are.
template <class Sizes, class Make>
std::vector<bool> resize(std::vector<vk::Buffer>& buffers, const Sizes& sizes, const Make& make) {
    std::vector<bool> is_new(sizes.size());
    while (buffers.size() > sizes.size())
        buffers.pop_back();
    for (size_t i = 0; i < sizes.size(); ++i) {
        is_new[i] = i >= buffers.size() || buffers[i].size() != std::max<uint64_t>(sizes[i], sizeof(uvec4));
        if (!is_new[i]) continue;
        if (i < buffers.size()) {
            buffers[i] = make(sizes[i], i);
        } else {
            buffers.push_back(make(sizes[i], i));
        }
    }
    return is_new;
}

// The names of the arrays in a buffer, for messages.
std::string names_in(uint32_t buffer) {
    std::string names;
    for (const SceneArray& array : SCENE_ARRAYS) {
        if (array.buffer == buffer) names += (names.empty() ? "" : ", ") + to_text(array);
    }
    return names;
}

}  // namespace

// All bindings of a kernel must be bound, so those that it does not read get buffers of one word.
SceneBuffers::SceneBuffers(const vk::Device& device, const GpuScene& scene, const Parameters& parameters,
                           const ArrayMap& map)
    : parameters_(device, (PARAMETERS_WORDS + STARTS_WORDS) * sizeof(uvec4), vk::BufferUsage::uniform,
                  "parameters") {
    update(scene, map, BufferSet().set());
    set(parameters);
}

// All bindings of a kernel must be bound, so those that it does not read get buffers of one word.
uint32_t SceneBuffers::update(const GpuScene& scene, const ArrayMap& map, const BufferSet& changed) {
    const Sizes sizes = device_sizes(scene, map);
    const vk::Device& device = parameters_.device();
    const auto new_storage = resize(storage_, sizes.storage, [&](uint64_t bytes, size_t i) {
        return vk::Buffer(device, bytes, vk::BufferUsage::storage, "storage " + std::to_string(i));
    });
    const auto new_texels = resize(texels_, sizes.texel, [&](uint64_t bytes, size_t i) {
        return vk::Buffer(device, bytes, vk::BufferUsage::texel, names_in(uint32_t(i)));
    });
    uint32_t copied = 0;
    std::array<uvec4, STARTS_WORDS> starts{};
    for (const auto& [number, buffer, name, words] : SCENE_ARRAYS) {
        const uint32_t slot = map.slots[buffer], start = map.starts[number];
        starts[number / 4][int(number % 4)] = start;
        const bool stays = !changed[buffer] && slot == map_.slots[buffer] && start == map_.starts[number] &&
                           !(slot == NO_SLOT ? new_texels[buffer] : new_storage[slot]);
        if (stays || scene.arrays[number].empty()) continue;
        vk::upload(slot == NO_SLOT ? texels_[buffer] : storage_[slot],
                   std::as_bytes(std::span(scene.arrays[number])), start * sizeof(uvec4));
        ++copied;
    }
    map_ = map;
    vk::upload(parameters_, std::as_bytes(std::span(starts)), PARAMETERS_WORDS * sizeof(uvec4));
    return copied;
}

void SceneBuffers::set(const Parameters& parameters) {
    const auto words = pack(parameters);
    vk::upload(parameters_, std::as_bytes(std::span(words)));
}

std::vector<vk::Binding> SceneBuffers::bindings(const KernelConstants& constants) {
    std::vector<vk::Binding> bindings{
        {BINDING_STORAGE, vk::BindingType::storage_buffer, constants[CONSTANT_STORAGE_BUFFERS]},
        {BINDING_PARAMETERS, vk::BindingType::uniform_buffer}};
    for (uint32_t i = 0; i < BUFFER_COUNT; ++i)
        bindings.push_back({i, vk::BindingType::texel_buffer});
    return bindings;
}

void SceneBuffers::bind_to(vk::Kernel& kernel) const {
    for (uint32_t i = 0; i < BUFFER_COUNT; ++i)
        kernel.bind(i, texels_[i]);
    for (uint32_t slot = 0; slot < storage_.size(); ++slot)
        kernel.bind(BINDING_STORAGE, storage_[slot], slot);
    kernel.bind(BINDING_PARAMETERS, parameters_);
}

}  // namespace candela
