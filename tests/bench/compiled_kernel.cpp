// See compiled_kernel.h.
#include "compiled_kernel.h"

#include <algorithm>
#include <span>

#include <volk.h>

#include "bench/clocks.h"
#include "gpu_scene/gpu_scene.h"
#include "view/display.h"
#include "vk/check.h"
#include "vk/transfer.h"

namespace candela {
namespace {

// The tone curve with the most code.
constexpr Tonemap CURVE = Tonemap::agx;

double value_of(const VkPipelineExecutableStatisticKHR& statistic) {
    switch (statistic.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
            return statistic.value.b32;
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
            return double(statistic.value.i64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
            return double(statistic.value.u64);
        default:
            return statistic.value.f64;
    }
}

// Asks the driver about the only executable of a kernel.
void query_statistics(const vk::Device& device, const vk::Kernel& kernel, CompiledKernel& row) {
    VkPipelineInfoKHR pipeline{};
    pipeline.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
    pipeline.pipeline = kernel.pipeline();
    uint32_t count = 1;
    VkPipelineExecutablePropertiesKHR properties{};
    properties.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    VK_CHECK(vkGetPipelineExecutablePropertiesKHR(device.handle(), &pipeline, &count, &properties));
    row.subgroup_size = properties.subgroupSize;

    VkPipelineExecutableInfoKHR executable{};
    executable.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
    executable.pipeline = kernel.pipeline();
    VK_CHECK(vkGetPipelineExecutableStatisticsKHR(device.handle(), &executable, &count, nullptr));
    VkPipelineExecutableStatisticKHR empty{};
    empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    std::vector<VkPipelineExecutableStatisticKHR> statistics(count, empty);
    VK_CHECK(vkGetPipelineExecutableStatisticsKHR(device.handle(), &executable, &count, statistics.data()));
    for (const VkPipelineExecutableStatisticKHR& statistic : statistics)
        row.statistics.emplace_back(statistic.name, value_of(statistic));
}

// Compiles a kernel by `make()` and queries it.
template <class Make>
CompiledKernel described(const vk::Device& device, const std::string& scene, const char* buffers,
                         const Make& make) {
    const Stopwatch watch;
    const vk::Kernel kernel = make();
    CompiledKernel row{.scene = scene, .kernel = kernel.name(), .buffers = buffers};
    row.cpu_seconds = watch.elapsed().cpu;
    query_statistics(device, kernel, row);
    return row;
}

// Does `work`, which is little else than compiling that kernel and dispatching it for the first time.
template <class Work>
CompiledKernel timed(const std::string& scene, const char* kernel, const char* buffers, const Work& work) {
    const Stopwatch watch;
    work();
    return {.scene = scene, .kernel = kernel, .buffers = buffers, .cpu_seconds = watch.elapsed().cpu};
}

const char* buffers_name(SceneAccess access) {
    return access == SceneAccess::texel_buffers ? "texel" : "storage";
}

std::vector<CompiledKernel> describe_all(const vk::Device& device, const std::string& name,
                                         const GpuScene& scene, const Camera& camera, RenderSettings settings,
                                         const std::vector<SceneAccess>& accesses) {
    std::vector<CompiledKernel> rows;
    for (const SceneAccess access : accesses) {
        settings.scene_access = access;
        const auto constants =
            kernel_constants(device, scene, map_arrays(device.info(), scene, access), camera, settings);
        for (const RenderKernel which : {RenderKernel::render, RenderKernel::position}) {
            rows.push_back(described(device, name, buffers_name(access),
                                     [&] { return make_kernel(device, which, constants); }));
        }
    }
    return rows;
}

std::vector<CompiledKernel> time_all(const vk::Device& device, const std::string& name, const GpuScene& scene,
                                     const Camera& camera, RenderSettings settings,
                                     const std::vector<SceneAccess>& accesses) {
    settings.crop = {0, 0, 1, 1};
    std::vector<CompiledKernel> rows;
    std::optional<Renderer> renderer;
    for (const SceneAccess access : accesses) {
        settings.scene_access = access;
        const char* const buffers = buffers_name(access);
        rows.push_back(
            timed(name, "render", buffers, [&] { renderer.emplace(device, scene, camera, settings); }));
        rows.push_back(timed(name, "position", buffers, [&] { renderer->positions(); }));
    }
    return rows;
}

}  // namespace

std::optional<double> CompiledKernel::find(std::string_view name) const {
    const auto found =
        std::ranges::find_if(statistics, [name](const auto& statistic) { return statistic.first == name; });
    return found == statistics.end() ? std::nullopt : std::optional(found->second);
}

vk::DeviceInfo statistics_device(vk::DeviceInfo info) {
    info.statistics = info.api_version >= VK_API_VERSION_1_2 &&
                      vk::has_extension(vk::device_extensions(info.handle),
                                        VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    if (info.statistics) info.reason.clear();
    return info;
}

std::vector<CompiledKernel> compile_scene_kernels(const vk::Device& device, const std::string& name,
                                                  const Scene& scene, const Camera& camera,
                                                  const RenderSettings& settings,
                                                  const std::vector<SceneAccess>& accesses) {
    const GpuScene gpu_scene = build_gpu_scene(scene);
    device.programs().forget();  // Another scene may have had the same kernels.
    const auto compile_all = device.info().statistics ? describe_all : time_all;
    return compile_all(device, name, gpu_scene, camera, settings, accesses);
}

CompiledKernel compile_display_kernel(const vk::Device& device) {
    if (device.info().statistics)
        return described(device, "", "", [&] { return make_display_kernel(device, CURVE, false); });
    const vk::StorageImage image = vk::make_storage_image(device, 1, 1, LAYER_COUNT_COLOUR, "accumulation");
    Display display(device, false);
    return timed("", "display", "", [&] { display.draw(image, {1, 1}, CURVE, 0.0f, {}); });
}

}  // namespace candela
