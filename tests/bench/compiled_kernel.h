// Kernels as a driver compiled them, and what it tells of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/renderer.h"
#include "scene/scene.h"
#include "vk/device.h"

namespace candela {

struct CompiledKernel {
    std::string scene;           // As the caller names it; empty if the kernel reads no scene.
    std::string kernel;          // "render", "position" or "display".
    std::string buffers;         // How it reads the scene: "texel" or "storage", or empty.
    double cpu_seconds = 0.0;    // CPU time that compiling took.
    uint32_t subgroup_size = 0;  // 0 if the driver does not tell.
    std::vector<std::pair<std::string, double>> statistics{};  // As the driver names them.

    // The statistic of that name, if the driver has it.
    std::optional<double> find(std::string_view name) const;
};

// The device as it must be opened for statistics, if it gives them. It will then do even if it lacks what
// running kernels takes, such as memory.
vk::DeviceInfo statistics_device(vk::DeviceInfo info);

// Compile the kernels that read a scene, with the constants that rendering it takes, for each of `accesses`,
// and the one that shows the picture. If the device gives statistics, nothing is submitted to it, so that a
// driver will do whose chip is missing. If it gives none, compiling includes a first dispatch, since some
// drivers do all the work only then.
std::vector<CompiledKernel> compile_scene_kernels(const vk::Device& device, const std::string& name,
                                                  const Scene& scene, const Camera& camera,
                                                  const RenderSettings& settings,
                                                  const std::vector<SceneAccess>& accesses);
CompiledKernel compile_display_kernel(const vk::Device& device);

}  // namespace candela
