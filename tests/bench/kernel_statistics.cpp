// Compiles the kernels of scenes and prints what the driver tells of them; with bounds, fails if one is
// exceeded.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/console.h"
#include "cli/rendering_options.h"
#include "cli/vulkan.h"
#include "compiled_kernel.h"
#include "kernel_bounds.h"
#include "load/load.h"
#include "vk/instance.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
    std::vector<std::string> scenes;
    std::optional<std::string> bounds;
    bool json = false;
    RenderingOptions rendering;
};

void add_options(CLI::App& app, Arguments& arguments) {
    app.description("Compiles the kernels of scenes, and prints what the driver tells of them");
    app.add_option("SCENE", arguments.scenes, "Scene files (.json)")->required()->type_name("");
    app.option_defaults()->take_last();
    app.add_flag("--json", arguments.json, "Print all statistics of the driver as JSON");
    app.add_option("--bounds", arguments.bounds, "Fail if a kernel is beyond its bound in this file")
        ->type_name("FILE");
    arguments.rendering.add_to(app);
}

// The device that `request` names, or the best one, ready to be opened.
vk::DeviceInfo find_device(const vk::Instance& instance, const std::optional<std::string>& request) {
    std::vector<vk::DeviceInfo> devices;
    for (const vk::DeviceInfo& info : instance.devices())
        devices.push_back(statistics_device(info));
    return vk::select_device(devices, request);
}

std::vector<CompiledKernel> compile(const vk::Device& device, const Arguments& arguments) {
    std::vector<SceneAccess> accesses{arguments.rendering.device.scene_access};
    if (accesses.front() == SceneAccess::automatic)
        accesses = {SceneAccess::texel_buffers, SceneAccess::storage_buffers};
    std::vector<CompiledKernel> all;
    for (const std::string& file : arguments.scenes) {
        const Scene scene = load_scene(file, {.reach = {.anywhere = true}});
        const Camera& camera = scene.cameras.front();
        RenderSettings settings = arguments.rendering.settings(scene, camera);
        settings.aovs = true;  // As for an EXR by default.
        const auto kernels = compile_scene_kernels(device, std::filesystem::path(file).stem().string(), scene,
                                                   camera, settings, accesses);
        all.insert(all.end(), kernels.begin(), kernels.end());
    }
    all.push_back(compile_display_kernel(device));
    return all;
}

std::string count_text(const std::optional<double>& value) {
    return value ? fixed(*value, 0) : "-";
}

void print_row(const std::vector<std::string>& cells) {
    constexpr int WIDTHS[] = {11, 8, 7, 8, 5, 6, 5, 5, 7, 13, 13, 6, 6};
    for (size_t i = 0; i < cells.size(); ++i)
        std::printf("| %-*s ", WIDTHS[i], cells[i].c_str());
    std::printf("|\n");
}

// Prints Markdown. Columns that the driver's statistics fill have the driver's names, but for shorter ones.
void print_table(const vk::DeviceInfo& info, const std::vector<CompiledKernel>& kernels) {
    std::printf("%s; %s\n\n", info.name.c_str(), info.driver.c_str());
    print_row({"scene", "kernel", "buffers", "subgroup", "VGPRs", "demand", "SGPRs", "waves", "scratch",
               "spilled VGPRs", "spilled SGPRs", "code", "CPU s"});
    print_row(std::vector<std::string>(13, "---"));
    for (const CompiledKernel& kernel : kernels) {
        const std::string subgroup = kernel.subgroup_size == 0 ? "-" : std::to_string(kernel.subgroup_size);
        print_row({kernel.scene, kernel.kernel, kernel.buffers, subgroup,
                   count_text(kernel.find(STATISTIC_VGPRS)), count_text(kernel.find(STATISTIC_VGPR_DEMAND)),
                   count_text(kernel.find("SGPRs")), count_text(kernel.find("Subgroups per SIMD")),
                   count_text(kernel.find(STATISTIC_SCRATCH)),
                   count_text(kernel.find(STATISTIC_SPILLED_VGPRS)), count_text(kernel.find("Spilled SGPRs")),
                   count_text(kernel.find("Code size")), fixed(kernel.cpu_seconds, 2)});
    }
}

void print_json(const vk::DeviceInfo& info, const std::vector<CompiledKernel>& kernels) {
    Json rows = Json::array();
    for (const CompiledKernel& kernel : kernels) {
        Json statistics = Json::object();
        for (const auto& [name, value] : kernel.statistics)
            statistics[name] = value;
        rows.push_back({{"scene", kernel.scene},
                        {"kernel", kernel.kernel},
                        {"buffers", kernel.buffers},
                        {"subgroup_size", kernel.subgroup_size},
                        {"cpu_seconds", kernel.cpu_seconds},
                        {"statistics", statistics}});
    }
    const Json report{{"device", info.name}, {"driver", info.driver}, {"kernels", rows}};
    std::printf("%s\n", report.dump(2).c_str());
}

// Prints what is wrong; throws Error if anything is.
void check_bounds(const KernelBounds& bounds, const std::string& device,
                  const std::vector<CompiledKernel>& kernels) {
    const std::vector<std::string> violations = find_violations(bounds, device, kernels);
    for (const std::string& violation : violations)
        print_error(violation);
    if (!violations.empty()) throw Error("kernels are beyond their bounds, see above");
}

void run(const Arguments& arguments) {
    std::optional<KernelBounds> bounds;
    if (arguments.bounds) bounds = load_kernel_bounds(*arguments.bounds);
    const vk::Instance instance(instance_options());
    const vk::Device device(instance, find_device(instance, arguments.rendering.device.name));
    const vk::DeviceInfo& info = device.info();
    if (bounds && info.driver != bounds->driver) {
        std::printf("skipped: the bounds are for the compiler of %s, and the driver here is %s\n",
                    bounds->driver.c_str(), info.driver.c_str());
        return;
    }
    const std::vector<CompiledKernel> kernels = compile(device, arguments);
    (arguments.json ? print_json : print_table)(info, kernels);
    flush_results();
    check_validation(instance);
    if (bounds) check_bounds(*bounds, info.name, kernels);
}

}  // namespace
}  // namespace candela

int main(int argc, char** argv) {
    // What the driver kept from another run would take no time to compile.
    ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    CLI::App app;
    candela::Arguments arguments;
    add_options(app, arguments);
    try {
        app.parse(argc, argv);
        run(arguments);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    } catch (const std::exception& error) {
        candela::print_error(error.what());
        return 1;
    }
}
