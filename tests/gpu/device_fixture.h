// What the tests of shader functions share: a device, and kernels that map an array of items to an array of
// results (tests/kernels/items.glsl), with or without a scene.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "gpu/vk_fixture.h"
#include "render/gpu_scene.h"
#include "render/renderer.h"
#include "shared/parameters.h"
#include "vk/commands.h"

namespace candela::kernels {
extern const std::span<const uint32_t> records, records_storage, octahedral, hash, sampler, warp, math,
    exponential, bsdf, frame, spawn, traversal, traversal_storage, light_sample, light_sample_storage,
    environment, interaction;
}

namespace candela {

// A scene's records on the device, for kernels that include scene/scene_data.glsl.
class DeviceScene {
  public:
    // `parameters` go to the device as they are. `access` is not `automatic`.
    DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access,
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
    // With the parameters that concern the scene alone.
    DeviceScene(const vk::Device& device, const GpuScene& scene, SceneAccess access)
        : DeviceScene(device, scene, access, parameters_of(scene)) {}

    uint32_t primitive_count() const { return primitive_count_; }

    std::vector<vk::Binding> bindings() const {
        const auto type = texels_ ? vk::BindingType::texel_buffer : vk::BindingType::storage_buffer;
        return {{BINDING_NODES, type},
                {BINDING_PRIMITIVES, type},
                {BINDING_TABLES, type},
                {BINDING_PARAMETERS, vk::BindingType::uniform_buffer}};
    }
    void bind_to(vk::Kernel& kernel) const {
        kernel.bind(BINDING_NODES, nodes_);
        kernel.bind(BINDING_PRIMITIVES, primitives_);
        kernel.bind(BINDING_TABLES, tables_);
        kernel.bind(BINDING_PARAMETERS, parameters_);
    }

  private:
    static Parameters parameters_of(const GpuScene& scene) {
        Parameters parameters{};
        parameters.light_count = scene.light_count;
        parameters.tables = scene.table_starts;
        parameters.environment_size = scene.environment_size;
        parameters.environment_turn = {std::cos(scene.environment_rotation),
                                       std::sin(scene.environment_rotation)};
        return parameters;
    }
    vk::Buffer upload(const vk::Device& device, const std::vector<uvec4>& words) const {
        const auto usage = texels_ ? vk::BufferUsage::texel : vk::BufferUsage::storage;
        vk::Buffer buffer(device, words.size() * sizeof(uvec4), usage, "records");
        buffer.upload(std::as_bytes(std::span(words)));
        return buffer;
    }

    bool texels_;
    uint32_t primitive_count_;
    vk::Buffer nodes_, primitives_, tables_, parameters_;
};

// A test with a device that is open. At its end the validation layer must have had nothing to say.
class DeviceTest : public vk::Vk {
  protected:
    DeviceTest() { device_.emplace(instance_, info_); }
    void TearDown() override {
        device_.reset();
        Vk::TearDown();
    }
    const vk::Device& device() const { return *device_; }

    // Runs a kernel of tests/kernels on all items. `Item` is a whole number of uvec4, `Result` of 32-bit
    // words, as the kernel reads and writes them; `constants` are its specialization constants.
    template <class Result, class Item>
    std::vector<Result> map(std::span<const uint32_t> spirv, const std::vector<Item>& items,
                            const std::vector<uint32_t>& constants = {},
                            const DeviceScene* scene = nullptr) const {
        static_assert(sizeof(Item) % sizeof(uvec4) == 0 && sizeof(Result) % sizeof(uint32_t) == 0);
        auto bindings = scene == nullptr ? std::vector<vk::Binding>{} : scene->bindings();
        bindings.push_back({ITEMS, vk::BindingType::texel_buffer});
        bindings.push_back({RESULTS, vk::BindingType::storage_buffer});
        vk::Kernel kernel(*device_, spirv, bindings, sizeof(Counts), constants, "test");
        if (scene != nullptr) scene->bind_to(kernel);
        vk::Commands commands(*device_);

        std::vector<Result> results(items.size());
        const size_t batch = GUARANTEED_TEXELS / (sizeof(Item) / sizeof(uvec4));
        for (size_t first = 0; first < items.size(); first += batch) {
            const std::span some = std::span(items).subspan(first, std::min(batch, items.size() - first));
            vk::Buffer in(*device_, some.size_bytes(), vk::BufferUsage::texel, "items");
            const vk::Buffer out(*device_, some.size() * sizeof(Result), vk::BufferUsage::readback,
                                 "results");
            in.upload(std::as_bytes(some));
            kernel.bind(ITEMS, in);
            kernel.bind(RESULTS, out);
            const Counts counts{uint32_t(some.size()), scene == nullptr ? 0 : scene->primitive_count()};
            commands.dispatch(kernel, std::as_bytes(std::span(&counts, 1)), {(counts.items + 63) / 64, 1, 1});
            commands.submit_and_wait();
            out.download(std::as_writable_bytes(std::span(results).subspan(first, some.size())));
        }
        return results;
    }

  private:
    static constexpr uint32_t ITEMS = 6, RESULTS = 7;
    static constexpr size_t GUARANTEED_TEXELS = 65536;  // The least maxTexelBufferElements of any device.
    struct Counts {
        uint32_t items;
        uint32_t triangles;
    };

    std::optional<vk::Device> device_;
};

}  // namespace candela
