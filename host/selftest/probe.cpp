// See probe.h.
#include "selftest/probe.h"

#include <algorithm>
#include <cmath>

#include "vk/commands.h"

namespace candela {
namespace {

// The least maxTexelBufferElements of any device.
constexpr size_t GUARANTEED_TEXELS = 65536;

Parameters parameters_of(const GpuScene& scene) {
    Parameters parameters{};
    parameters.light_count = scene.light_count;
    parameters.tables = scene.table_starts;
    parameters.environment_size = scene.environment_size;
    parameters.environment_turn = {std::cos(scene.environment_rotation),
                                   std::sin(scene.environment_rotation)};
    return parameters;
}

}  // namespace

DeviceScene::DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access,
                         const Parameters& parameters)
    : texels_(access == SceneAccess::texel_buffers),
      primitive_count_(scene.primitive_count),
      nodes_(upload(device, scene.nodes)),
      primitives_(upload(device, scene.primitives)),
      tables_(upload(device, scene.tables)),
      parameters_(device, PARAMETERS_WORDS * sizeof(uvec4), vk::BufferUsage::uniform, "parameters") {
    const auto words = pack(parameters);
    parameters_.upload(std::as_bytes(std::span(words)));
}

DeviceScene::DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access)
    : DeviceScene(device, scene, access, parameters_of(scene)) {}

std::vector<vk::Binding> DeviceScene::bindings() const {
    const auto type = texels_ ? vk::BindingType::texel_buffer : vk::BindingType::storage_buffer;
    return {{BINDING_NODES, type},
            {BINDING_PRIMITIVES, type},
            {BINDING_TABLES, type},
            {BINDING_PARAMETERS, vk::BindingType::uniform_buffer}};
}

void DeviceScene::bind_to(vk::Kernel& kernel) const {
    kernel.bind(BINDING_NODES, nodes_);
    kernel.bind(BINDING_PRIMITIVES, primitives_);
    kernel.bind(BINDING_TABLES, tables_);
    kernel.bind(BINDING_PARAMETERS, parameters_);
}

vk::Buffer DeviceScene::upload(const vk::Device& device, const std::vector<uvec4>& words) const {
    const auto usage = texels_ ? vk::BufferUsage::texel : vk::BufferUsage::storage;
    vk::Buffer buffer(device, words.size() * sizeof(uvec4), usage, "records");
    buffer.upload(std::as_bytes(std::span(words)));
    return buffer;
}

std::vector<uint32_t> traversal_constants(const GpuScene& scene) {
    std::vector<uint32_t> constants(CONSTANT_COUNT);
    constants[CONSTANT_PRIMITIVES] = scene.primitives_present;
    constants[CONSTANT_BVH_DEPTH] = scene.bvh_depth;
    return constants;
}

std::vector<uint32_t> run_probe(const vk::Device& device, std::span<const uint32_t> spirv,
                                std::span<const std::byte> items, size_t item_words, size_t result_words,
                                const std::vector<uint32_t>& constants, const DeviceScene* scene) {
    auto bindings = scene == nullptr ? std::vector<vk::Binding>{} : scene->bindings();
    bindings.push_back({PROBE_ITEMS, vk::BindingType::texel_buffer});
    bindings.push_back({PROBE_RESULTS, vk::BindingType::storage_buffer});
    vk::Kernel kernel(device, spirv, bindings, sizeof(ProbeCounts), constants, "probe");
    if (scene != nullptr) scene->bind_to(kernel);
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
        in.upload(some);
        kernel.bind(PROBE_ITEMS, in);
        kernel.bind(PROBE_RESULTS, out);
        const ProbeCounts counts{uint32_t(size), scene == nullptr ? 0 : scene->primitive_count()};
        commands.dispatch(kernel, std::as_bytes(std::span(&counts, 1)),
                          {(counts.items + PROBE_GROUP - 1) / PROBE_GROUP, 1, 1});
        commands.submit_and_wait();
        out.download(std::as_writable_bytes(results_of_some));
    }
    return results;
}

}  // namespace candela
