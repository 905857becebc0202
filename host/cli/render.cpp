// `candela render`: from a scene file to image files.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/vulkan.h"
#include "render/gpu_scene.h"
#include "render/renderer.h"
#include "scene/loader.h"
#include "vk/device.h"
#include "vk/instance.h"

namespace candela {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

const Camera& choose_camera(const Scene& scene, const std::optional<std::string>& name) {
    if (!name) return scene.cameras.front();
    std::string names;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == *name) return camera;
        names += (names.empty() ? "" : ", ") + camera.name;
    }
    throw Error("--camera: unknown camera \"" + *name + "\" (defined: " + names + ")", ExitCode::usage);
}

// What --verbose tells before rendering.
void print_details(const vk::Device& device, const GpuScene& scene, const RenderRecord& record) {
    const vk::DeviceInfo& info = device.info();
    std::fprintf(stderr, "device: %s (%s), Vulkan %s, driver %s\n", info.name.c_str(),
                 vk::to_string(info.type), vk::version_text(info.api_version).c_str(), info.driver.c_str());
    std::fprintf(stderr, "scene: %u primitives, %u lights, loaded in %s s\n", scene.id_count,
                 scene.light_count, fixed(record.load_seconds, 3).c_str());
    std::fprintf(stderr, "BVH: depth %u, SAH cost %s, built in %s s\n", scene.bvh_depth,
                 fixed(double(scene.bvh_sah_cost), 2).c_str(), fixed(scene.bvh_seconds, 3).c_str());
    std::fprintf(stderr, "device memory: %s of %s (scene %s)\n", bytes_text(record.device_bytes).c_str(),
                 bytes_text(device.available_memory()).c_str(), bytes_text(scene.bytes()).c_str());
}

// Renders until all samples are there, the time is over or a signal comes; the record learns what it took.
void trace(Renderer& renderer, const RenderOptions& options, uint32_t target, const InterruptGuard& guard,
           RenderRecord& record) {
    const PixelRect& crop = record.settings.crop;
    Progress progress(uint64_t{crop.width()} * crop.height(), target, options.time_limit, options.quiet);
    const std::clock_t cpu_start = std::clock();
    record.complete = renderer.render(target, [&](double done) {
        progress.update(done);
        return !guard.interrupted() && !(options.time_limit && progress.seconds() >= *options.time_limit);
    });
    record.render_seconds = progress.seconds();
    record.cpu_seconds = double(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    record.counters = renderer.counters();
}

Image collect_image(Renderer& renderer, const AovSelection& aovs, RenderRecord& record) {
    const Accumulation state = renderer.download();
    record.samples = state.total_samples();
    record.spp = UINT32_MAX;
    for (size_t i = 0; i < state.pixel_count(); ++i)
        record.spp = std::min(record.spp, state.sample_count(i));
    Image image =
        make_image(state, aovs, aovs.needs_positions() ? renderer.positions() : std::vector<float>{});
    record.image_hash = image_hash(image);
    return image;
}

void print_outcome(const RenderRecord& record, uint32_t target, bool quiet) {
    if (record.counters.nonfinite_samples > 0) {
        print_warning(std::to_string(record.counters.nonfinite_samples) +
                      " sample(s) were not finite and count as black");
    }
    if (record.counters.depth_limit_hits > 0) {
        print_warning(std::to_string(record.counters.depth_limit_hits) + " path(s) were cut after " +
                      std::to_string(DEPTH_SAFETY_LIMIT) + " bounces, and their light is missing");
    }
    if (record.spp == 0) print_warning("stopped before every pixel had a sample; those without are black");
    if (quiet) return;
    const std::string of_target = record.complete ? "" : " of " + std::to_string(target);
    const double rate = double(record.samples) / std::max(record.render_seconds, 1e-9);
    std::fprintf(stderr, "rendered %u%s spp in %s (%s Msamples/s)\n", record.spp, of_target.c_str(),
                 duration_text(record.render_seconds).c_str(), fixed(rate / 1e6, 2).c_str());
}

// What is left to do once there is a device.
ExitCode render_on(const vk::Instance& instance, const RenderOptions& options, const GpuScene& scene,
                   const Camera& camera, uint32_t target, RenderRecord& record) {
    const std::vector<vk::DeviceInfo> devices = instance.devices();
    const vk::Device device(instance, vk::select_device(devices, options.device), pipeline_cache_file());
    record.device = device.info().name;
    record.driver = device.info().driver;
    record.device_bytes = device_bytes(scene, record.settings);
    if (options.verbose) print_details(device, scene, record);

    Renderer renderer(device, scene, camera, record.settings);
    record.settings.scene_access = renderer.scene_access();
    record.pipeline_seconds = renderer.pipeline_seconds();

    // Before this line there is nothing to keep, and a signal ends the program at once.
    const InterruptGuard guard;
    trace(renderer, options, target, guard, record);
    const bool interrupted = guard.interrupted() && !record.complete;
    Image image = collect_image(renderer, options.written_aovs(), record);
    print_outcome(record, target, options.quiet);
    record.validation_messages = instance.validation_messages().size();
    write_outputs(options, record, camera, std::move(image));
    return interrupted ? ExitCode::interrupted : ExitCode::done;
}

ExitCode render(const RenderOptions& options, const std::string& command_line) {
    check_outputs(options);
    RenderRecord record;
    record.command_line = command_line;

    const auto start = std::chrono::steady_clock::now();
    const Scene scene = load_scene(options.scene_file);
    record.load_seconds = seconds_since(start);
    for (const std::string& warning : scene.warnings)
        print_warning(warning);
    const Camera& camera = choose_camera(scene, options.camera);
    record.settings = options.settings(scene);

    const GpuScene gpu_scene = build_gpu_scene(scene);
    record.primitives = gpu_scene.id_count;
    record.lights = gpu_scene.light_count;
    record.bvh_seconds = gpu_scene.bvh_seconds;

    const vk::Instance instance(instance_options());
    const ExitCode code = render_on(instance, options, gpu_scene, camera, options.target_spp(scene), record);
    check_validation(instance);
    return code;
}

}  // namespace

Command add_render_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command = app.add_subcommand("render", "Render a scene to image files");
    const auto options = std::make_shared<RenderOptions>();
    options->add_to(*command);
    command->footer(
        "Example:\n"
        "  candela render scenes/cornell-box.json -o box.exr -o box.png --spp 256 --size 512x512\n\n"
        "Ctrl-C stops early and writes the image so far (exit code 130); a second Ctrl-C ends at once.");
    return {command, [options, command_line] { return render(*options, command_line); }};
}

}  // namespace candela
