// See probe.h.
#include "probe/probe.h"

#include <algorithm>
#include <cmath>

#include "gpu_scene/light_tree_arrays.h"
#include "shared/constants.h"
#include "vk/buffer.h"
#include "vk/commands.h"
#include "vk/transfer.h"

namespace candela {
namespace {

// The maxTexelBufferElements that Vulkan guarantees.
constexpr size_t GUARANTEED_TEXELS = 65536;

Parameters parameters_of(const GpuScene& scene) {
    Parameters parameters{};
    parameters.lights = turned(scene.light_groups, scene.environment_rotation);
    parameters.environment_size = scene.environment_size;
    parameters.environment_turn = {std::cos(scene.environment_rotation),
                                   std::sin(scene.environment_rotation)};
    return parameters;
}

}  // namespace

DeviceScene::DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access,
                         const Parameters& parameters)
    : primitive_count_(scene.primitive_count),
      buffers_(device, scene, parameters, map_arrays(device.info(), scene, access)) {}

DeviceScene::DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access)
    : DeviceScene(device, scene, access, parameters_of(scene)) {}

KernelConstants traversal_constants(const GpuScene& scene) {
    KernelConstants constants;
    constants[CONSTANT_PRIMITIVES] = scene.primitives_present;
    constants[CONSTANT_BVH_DEPTH] = scene.bvh_depth;
    constants[CONSTANT_INSTANCED] = !scene.instances.empty();
    constants[CONSTANT_ATTRIBUTES] = scene.attributes;
    constants[CONSTANT_TEXTURED] = scene.textured;
    constants[CONSTANT_TEXTURE_TRAITS] = scene.texture_traits;
    return constants;
}

KernelConstants sampler_constants(uint32_t sampler) {
    KernelConstants constants;
    constants[CONSTANT_SAMPLER] = sampler;
    return constants;
}

vk::Kernel make_probe(const vk::Device& device, std::span<const uint32_t> spirv, KernelConstants constants,
                      const DeviceScene* scene, const std::string& name) {
    std::vector<vk::Binding> bindings{{BINDING_ITEMS, vk::BindingType::texel_buffer},
                                      {BINDING_RESULTS, vk::BindingType::storage_buffer}};
    if (scene != nullptr) {
        set_arrays(constants, scene->buffers().map());
        const auto of_scene = SceneBuffers::bindings(constants);
        bindings.insert(bindings.end(), of_scene.begin(), of_scene.end());
    }
    vk::Kernel kernel(device, spirv, bindings, sizeof(ProbeCounts), constants.values, name);
    if (scene != nullptr) scene->buffers().bind_to(kernel);
    return kernel;
}

std::vector<uint32_t> run_probe(const vk::Device& device, vk::Kernel& kernel,
                                std::span<const std::byte> items, size_t item_words, size_t result_words,
                                const DeviceScene* scene) {
    if (scene != nullptr) scene->buffers().bind_to(kernel);
    vk::Commands commands(device);

    const size_t item_bytes = item_words * sizeof(uvec4);
    const size_t count = items.size() / item_bytes;
    const size_t batch = GUARANTEED_TEXELS / item_words;
    std::vector<uint32_t> results(count * result_words);
    for (size_t first = 0; first < count; first += batch) {
        const size_t size = std::min(batch, count - first);
        const auto some = items.subspan(first * item_bytes, size * item_bytes);
        const auto results_of_some = std::span(results).subspan(first * result_words, size * result_words);
        vk::Buffer in(device, some.size(), vk::BufferUsage::texel, "items");
        const vk::Buffer out(device, results_of_some.size_bytes(), vk::BufferUsage::readback, "results");
        vk::upload(in, some);
        kernel.bind(BINDING_ITEMS, in);
        kernel.bind(BINDING_RESULTS, out);
        const ProbeCounts counts{uint32_t(size), scene == nullptr ? 0 : scene->primitive_count()};
        commands.dispatch(kernel, std::as_bytes(std::span(&counts, 1)),
                          {(counts.items + PROBE_GROUP - 1) / PROBE_GROUP, 1, 1});
        commands.submit_and_wait();
        vk::download(out, std::as_writable_bytes(results_of_some));
    }
    return results;
}

}  // namespace candela
