// Probes: small kernels (shaders/probes) that map an array of items to an array of results with the
// renderer's own shader functions, with or without a scene.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "render/scene_buffers.h"
#include "shared/kernel_constants.h"
#include "shared/parameters.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace candela {

// A scene's records on the device, for probes that include scene/scene_data.glsl.
class DeviceScene {
  public:
    // Uploads `parameters` unchanged.
    DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access,
                const Parameters& parameters);
    // Sets only the parameters that depend on the scene alone.
    DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access);

    uint32_t primitive_count() const { return primitive_count_; }
    const SceneBuffers& buffers() const { return buffers_; }

  private:
    uint32_t primitive_count_;
    SceneBuffers buffers_;
};

// Specialization constants of probes that trace rays: what is in the scene.
KernelConstants traversal_constants(const GpuScene& scene);
// The same for probes that draw samples; `sampler` is one of SAMPLER_*.
KernelConstants sampler_constants(uint32_t sampler);

// As declared by shaders/probes/items.glsl: invocations in a work group, and push constants.
inline constexpr uint32_t PROBE_GROUP = 64;
struct ProbeCounts {
    uint32_t items;
    uint32_t primitives;
};

// Makes the probe `spirv`, bound to the scene unless that is null. The scene's buffers set the constants for
// reading arrays. `name` is for messages.
vk::Kernel make_probe(const vk::Device& device, std::span<const uint32_t> spirv, KernelConstants constants,
                      const DeviceScene* scene, const std::string& name);

// Runs a probe on all items of `item_words` uvec4 each; returns `result_words` 32-bit words per item, in
// order. The scene may differ from that of make_probe() if its buffers are of the same kinds.
std::vector<uint32_t> run_probe(const vk::Device& device, vk::Kernel& kernel,
                                std::span<const std::byte> items, size_t item_words, size_t result_words,
                                const DeviceScene* scene);

// The same with types: an `Item` is a whole number of uvec4, a `Result` of 32-bit words, as the probe reads
// and writes them.
template <class Result, class Item>
std::vector<Result> probe(const vk::Device& device, vk::Kernel& kernel, const std::vector<Item>& items,
                          const DeviceScene* scene) {
    constexpr size_t TEXEL = sizeof(uvec4);
    static_assert(sizeof(Item) % TEXEL == 0 && sizeof(Result) % sizeof(uint32_t) == 0);
    const std::vector<uint32_t> words =
        run_probe(device, kernel, std::as_bytes(std::span(items)), sizeof(Item) / TEXEL,
                  sizeof(Result) / sizeof(uint32_t), scene);
    std::vector<Result> results(items.size());
    std::memcpy(static_cast<void*>(results.data()), words.data(), results.size() * sizeof(Result));
    return results;
}

// The same with a kernel made for this call.
template <class Result, class Item>
std::vector<Result> probe(const vk::Device& device, std::span<const uint32_t> spirv,
                          const std::vector<Item>& items, const KernelConstants& constants = {},
                          const DeviceScene* scene = nullptr) {
    vk::Kernel kernel = make_probe(device, spirv, constants, scene, "probe");
    return probe<Result>(device, kernel, items, scene);
}

}  // namespace candela
