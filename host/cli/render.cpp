// `candela render`: from a scene file to image files.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/attempts.h"
#include "cli/command.h"
#include "cli/command_files.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/loading.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/vulkan.h"
#include "film/identity.h"
#include "gpu_scene/gpu_scene.h"
#include "session/checkpoints.h"
#include "session/convergence.h"
#include "session/record.h"
#include "session/rendering.h"
#include "vk/instance.h"

namespace candela {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Prints what --verbose adds before rendering.
void print_details(const vk::Device& device, const GpuScene& scene, const RenderRecord& record) {
    const vk::DeviceInfo& info = device.info();
    print_note("device: " + info.name + " (" + vk::to_string(info.type) + "), Vulkan " +
               vk::version_text(info.api_version) + ", driver " + info.driver);
    std::fprintf(stderr, "scene: %u primitives, %u lights, loaded in %s s\n", scene.id_count,
                 scene.light_count, fixed(record.load_seconds, 3).c_str());
    std::fprintf(stderr, "BVH: depth %u, SAH cost %s, built in %s s\n", scene.bvh_depth,
                 fixed(double(scene.bvh_sah_cost), 2).c_str(), fixed(scene.bvh_seconds, 3).c_str());
    std::fprintf(stderr, "device memory: %s of %s (scene %s)\n", bytes_text(record.device_bytes).c_str(),
                 bytes_text(device.available_memory()).c_str(), bytes_text(scene.bytes()).c_str());
}

// `, estimated error 0.0183 (target 0.02)`, or nothing.
std::string error_text(const RenderRecord& record) {
    if (!record.target_error) return "";
    return ", estimated error " + (record.estimated_error ? fixed(*record.estimated_error, 4) : "unknown") +
           " (target " + fixed(*record.target_error, 4) + ')';
}

void print_outcome(const MessageOptions& messages, const RenderRecord& record, uint32_t target) {
    if (record.counters.nonfinite_samples > 0) {
        print_warning(std::to_string(record.counters.nonfinite_samples) +
                      " sample(s) were not finite; they are treated as black");
    }
    if (record.counters.depth_limit_hits > 0) {
        print_warning(std::to_string(record.counters.depth_limit_hits) + " path(s) were cut off after " +
                      std::to_string(DEPTH_SAFETY_LIMIT) +
                      " bounces; the light that they would have found is missing");
    }
    if (record.spp == 0)
        print_warning("stopped before every pixel had a sample; pixels without one are black");
    if (record.target_error && record.complete &&
        !(record.estimated_error && *record.estimated_error <= *record.target_error)) {
        print_warning("the target error was not reached with " + std::to_string(target) +
                      " samples per pixel; allow more (--spp)");
    }
    if (messages.quiet || messages.progress == ProgressStyle::json) return;
    const std::string of_target = record.complete ? "" : " of " + std::to_string(target);
    const double rate = double(record.samples) / std::max(record.render_seconds, 1e-9);
    std::fprintf(stderr, "rendered %u%s spp in %s (%s Msamples/s)%s\n", record.spp, of_target.c_str(),
                 duration_text(record.render_seconds).c_str(), fixed(rate / 1e6, 2).c_str(),
                 error_text(record).c_str());
}

void warn_of_device_failure(const Error& error, uint32_t kept, double submission_seconds) {
    print_warning(std::string(error.what()) + "; reopening the device and continuing from " +
                  std::to_string(kept) + " samples per pixel in submissions of " +
                  fixed(1e3 * submission_seconds, 3) + " ms");
}

void warn_of_maker(const Maker& before, const Maker& now) {
    if (before == now) return;
    print_warning("the checkpoint was made by " + to_text(before) + ", and this is " + to_text(now) +
                  ": the image is correct, but its bits are not those of a single program or device");
}

// The checkpoint that the job asks to continue from, if there is one yet.
std::optional<Checkpoint> resume(const RenderJob& job, const RenderRecord& record,
                                 const vk::DeviceInfo& device, const MessageOptions& messages) {
    std::optional<Checkpoint> checkpoint = load_to_resume(job, record.identity);
    if (checkpoint) {
        warn_of_maker(checkpoint->header.maker, make_maker(device));
    } else if (job.checkpoint.resume && !messages.quiet) {
        print_note('"' + *job.checkpoint.file + "\" does not exist yet: starting from the beginning");
    }
    return checkpoint;
}

// Writes all files. If one fails, still writes the others, and then throws the Error; throws `failure`
// instead, if there is one.
void write_files(Rendering& rendering, const OutputOptions& outputs, const MessageOptions& messages,
                 const vk::Instance& instance, const std::optional<Error>& failure, uint32_t target) {
    Image image = rendering.image();
    RenderRecord record = rendering.record();
    print_outcome(messages, record, target);
    record.validation_messages = instance.validation_messages().size();
    Attempts attempts;
    attempts.attempt([&] { rendering.finish_checkpoint(); });
    attempts.attempt([&] { write_outputs(outputs.images, outputs.report, record, std::move(image)); });
    attempts.attempt([&] {
        if (failure) throw Error(*failure);
    });
    attempts.finish();
}

// Renders on an instance, and writes the files.
ExitCode render_on(const vk::Instance& instance, const vk::DeviceInfo& device, const GpuScene& scene,
                   const RenderJob& job, const OutputOptions& outputs, const MessageOptions& messages,
                   std::optional<Image> reference, RenderRecord record) {
    std::optional<Checkpoint> resumed = resume(job, record, device, messages);
    DeviceSlot slot(instance, device, pipeline_cache_folder());
    Rendering rendering({.device = &slot,
                         .scene = &scene,
                         .resumed = std::move(resumed),
                         .reference = std::move(reference)},
                        job, std::move(record));
    if (messages.verbose) print_details(rendering.device(), scene, rendering.record());
    const PixelRect& crop = job.settings.crop;
    Progress progress(uint64_t{crop.width()} * crop.height(), job.target,
                      double(rendering.spp()) / job.target, job.time_limit, messages.progress_style());

    // Before this line there is nothing to keep, and a signal ends the program at once.
    const InterruptGuard guard;
    const std::optional<Error> failure = rendering.run(
        {.progress = [&](double done, std::optional<double> error) { progress.update(done, error); },
         .keep_going = [&] { return !guard.interrupted(); },
         .warn = print_warning,
         .device_failed = warn_of_device_failure,
         .write = [&](const RenderRecord& current,
                      Image image) { write_current_images(outputs.images, current, std::move(image)); }});
    progress.clear();
    const bool complete = rendering.record().complete;
    const bool interrupted = guard.interrupted() && !complete;
    write_files(rendering, outputs, messages, instance, failure, job.target);
    progress.end(complete ? "done" : interrupted ? "interrupted" : "time limit");
    return interrupted ? ExitCode::interrupted : ExitCode::done;
}

// The files that the command line names.
CommandFiles files_of(const SceneOptions& scene, const OutputOptions& outputs,
                      const CheckpointOptions& checkpoint) {
    CommandFiles files;
    files.read("SCENE", scene.file);
    if (outputs.reference) files.read("--reference", *outputs.reference);
    for (const std::string& path : outputs.images.files)
        files.write("-o", path);
    if (outputs.report) files.write("--report", *outputs.report);
    if (checkpoint.file) files.write("--checkpoint", *checkpoint.file);
    return files;
}

// Gives the scene the cameras that the options ask for, if there are any, instead of its own.
void take_cameras(const RenderOptions& options, Scene& scene) {
    std::vector<Camera> cameras = options.cameras.cameras(scene, options.rendering.picture.size);
    if (cameras.empty()) return;
    if (cameras.size() > 1 && !options.scene.camera && !options.cameras.file) {
        throw Error("there are " + std::to_string(cameras.size()) + " views, \"" + cameras.front().name +
                        "\" to \"" + cameras.back().name + "\"; choose one of them with --camera",
                    ErrorKind::request);
    }
    scene.cameras = std::move(cameras);
}

ExitCode render(const RenderOptions& options, const std::string& command_line) {
    const OutputOptions& outputs = options.outputs;
    CommandFiles files = files_of(options.scene, outputs, options.checkpoint);
    check_outputs(outputs.images);
    check_report(outputs.report);
    check_checkpoint(options.checkpoint);
    options.cameras.check(files);

    const auto start = std::chrono::steady_clock::now();
    const ProgressStyle style = options.messages.progress_style();
    Scene scene = load_with_progress(options.scene.file, options.rendering.loading, style);
    files.read_all("the scene's file", scene.files);
    const double load_seconds = seconds_since(start);
    take_cameras(options, scene);
    const RenderJob job = options.job(scene);
    options.cameras.write({{job.camera, job.settings.size, outputs.images.files.front()}});
    std::optional<Image> reference;
    if (outputs.reference) reference = load_reference(*outputs.reference, job.settings);

    warn_of_unseen_lights(scene, job.settings.estimator);
    const GpuScene gpu_scene = build_with_progress(scene, style);
    RenderRecord record = make_record(scene, gpu_scene, job);
    record.command_line = command_line;
    record.scene_file = options.scene.file;
    record.load_seconds = load_seconds;
    record.reference = outputs.reference;

    const vk::Instance instance(instance_options());
    const vk::DeviceInfo device = vk::select_device(instance.devices(), options.rendering.device.name);
    const ExitCode code = render_on(instance, device, gpu_scene, job, outputs, options.messages,
                                    std::move(reference), std::move(record));
    check_validation(instance);
    return code;
}

constexpr const char* FOOTER = R"(Example:
  candela render scenes/cornell-box.json -o box.exr -o box.png --spp 256 --size 512x512

Ctrl-C stops early and writes the image so far (exit code 130); so does closing the terminal, except under
nohup. A second Ctrl-C ends the program at once.

With --checkpoint a rendering survives the end of the program: the same command with --resume continues it,
to the same bits. Scripts can always pass --resume, even the first time.
--target-error compares the image with that of half as many samples, at powers of two from 16 on. This is the
error for --sampler independent, and more than the error for samplers that converge faster. It excludes light
that no sample has found yet. A resumed rendering estimates the error anew, and may need up to twice as many
samples.
--adaptive renders two halves with different seeds. Each puts its samples where the other shows that they
remove the most noise for their time, so there is no bias. The image is their mean, and their difference gives
the estimated error. It keeps four states in memory instead of one, and its images cannot be merged.
--progress json prints an object twice a second, and a last one, whose state is neither "loading" nor
"rendering", when all files are written; after an error there is none.
--samples 0..64 on one computer, --samples 64..128 on another: candela merge joins the parts.)";

}  // namespace

Command add_render_command(CLI::App& app, const std::string& command_line) {
    CLI::App* const command = app.add_subcommand("render", "Render a scene to image files");
    const auto options = std::make_shared<RenderOptions>();
    options->add_to(*command);
    command->footer(FOOTER);
    return {command, [options, command_line] { return render(*options, command_line); }};
}

}  // namespace candela
