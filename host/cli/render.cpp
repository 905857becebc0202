// `candela render`: from a scene file to image files.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/attempts.h"
#include "cli/checkpoints.h"
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
#include "render/make_identity.h"
#include "session/adaptive.h"
#include "session/convergence.h"
#include "session/interval.h"
#include "session/steady_renderer.h"
#include "version.h"
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

Image collect_image(SteadyRenderer& renderer, const AovSelection& aovs, RenderRecord& record) {
    const std::span<const Accumulation> states = renderer.states();
    const SampleCounts counts = count_samples(states);
    record.samples = counts.total;
    record.spp = samples_per_pixel(states);
    record.most_spp = counts.most;
    Image image = make_image(states, aovs, renderer.positions());
    record.image_hash = image_hash(image);
    return image;
}

// What is done at intervals during a rendering.
struct Upkeep {
    std::optional<CheckpointWriter> checkpoints;
    std::optional<Interval> images;  // From one writing of the outputs to the next.
    Convergence convergence;
    Progress progress;
    double seconds_before = 0.0;  // Of rendering before it was resumed.
    uint32_t planned = 0;         // Of an adaptive rendering: see render_pass().

    double seconds() const { return seconds_before + progress.seconds(); }
};

CheckpointHeader checkpoint_header(const RenderRecord& record, double seconds, const Upkeep& upkeep) {
    return {.identity = record.identity,
            .maker = record.maker,
            .render_seconds = seconds,
            .planned = upkeep.planned};
}

// Writes a checkpoint and the images if they are due.
void keep(SteadyRenderer& renderer, const ImageOutputs& outputs, const RenderRecord& record, Upkeep& upkeep) {
    if (upkeep.checkpoints && upkeep.checkpoints->due()) {
        renderer.hold();
        upkeep.checkpoints->write(checkpoint_header(record, upkeep.seconds(), upkeep), renderer.states());
    }
    if (upkeep.images && upkeep.images->over()) {
        renderer.hold();
        RenderRecord current = record;
        current.render_seconds = upkeep.seconds();
        Image image = collect_image(renderer, outputs.written_aovs(), current);
        write_current_images(outputs, current, std::move(image));
        upkeep.images->restart();
    }
}

// Renders until all samples are there, the error is small enough or `keep_going` returns false; returns false
// only in the last case. Looks at the error at fixed numbers of samples or, if nobody needs that, only at the
// end.
bool render_and_look(SteadyRenderer& renderer, bool adaptive, uint32_t target, Upkeep& upkeep,
                     const std::function<bool()>& keep_going) {
    Convergence& convergence = upkeep.convergence;
    uint32_t held = samples_per_pixel(renderer.states());
    if (held > 0) convergence.look(renderer.states(), upkeep.seconds());
    while (held < target && !convergence.reached()) {
        const uint32_t next = adaptive ? next_pass_end(held, target) : convergence.next(held, target);
        const auto update = [&](double done) {
            upkeep.progress.update(done * next / target, convergence.estimate());
            return keep_going();
        };
        const bool complete =
            adaptive ? render_pass(renderer, next, upkeep.planned, update) : renderer.render(next, update);
        if (!complete) return false;
        held = next;
        convergence.look(renderer.states(), upkeep.seconds());
        upkeep.progress.update(double(held) / target, convergence.estimate());
    }
    return true;
}

// Renders, with all upkeep, and records times, counters and errors. Returns the Error if the device failed
// for good.
std::optional<Error> trace(SteadyRenderer& renderer, const RenderJob& job, const InterruptGuard& guard,
                           Upkeep& upkeep, RenderRecord& record) {
    const std::clock_t cpu_start = std::clock();
    std::optional<Error> failure;
    try {
        record.complete = render_and_look(renderer, job.adaptive, job.target, upkeep, [&] {
            keep(renderer, job.images, record, upkeep);
            return !guard.interrupted() && !(job.time_limit && upkeep.progress.seconds() >= *job.time_limit);
        });
    } catch (const Error& error) {
        if (count_samples(renderer.states()).total == 0) throw;
        failure = error;
    }
    upkeep.progress.clear();
    record.render_seconds = upkeep.seconds();
    record.cpu_seconds = double(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    record.counters = total_counters(renderer.states());
    record.device_failures = renderer.failures();
    record.convergence = upkeep.convergence.points();
    record.estimated_error = upkeep.convergence.estimate();
    return failure;
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
                      " sample(s) were not finite and count as black");
    }
    if (record.counters.depth_limit_hits > 0) {
        print_warning(std::to_string(record.counters.depth_limit_hits) + " path(s) were cut after " +
                      std::to_string(DEPTH_SAFETY_LIMIT) + " bounces, and their light is missing");
    }
    if (record.spp == 0) print_warning("stopped before every pixel had a sample; those without are black");
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
    print_warning(std::string(error.what()) + "; opening the device again, and going on from " +
                  std::to_string(kept) + " samples per pixel in submissions of " +
                  fixed(1e3 * submission_seconds, 3) + " ms");
}

void warn_of_maker(const Maker& before, const Maker& now) {
    if (before == now) return;
    print_warning("the checkpoint was made by " + to_text(before) + ", and this is " + to_text(now) +
                  ": the image is right, but not the same bits as if one had made it all");
}

// Renders on an instance, and writes the files.
ExitCode render_on(const vk::Instance& instance, const vk::DeviceInfo& device, const GpuScene& scene,
                   const RenderJob& job, const std::optional<std::string>& report,
                   std::optional<Image> reference, RenderRecord& record) {
    std::optional<Checkpoint> resumed = load_to_resume(job, record.identity);
    record.maker = {.device = device.name, .driver = device.driver, .version = CANDELA_VERSION};
    record.device_bytes = device_bytes(scene, job.settings);
    const AovSelection aovs = job.images.written_aovs();
    SteadyRenderer::Source source{.instance = &instance,
                                  .device = device,
                                  .pipeline_cache_folder = pipeline_cache_folder(),
                                  .scene = &scene,
                                  .camera = &job.camera,
                                  .settings = job.settings,
                                  .states = {empty_state(job.settings)},
                                  .positions = aovs.needs_positions()};
    if (job.adaptive) source.states = adaptive_states(job.settings);
    if (resumed) {
        warn_of_maker(resumed->header.maker, record.maker);
        record.render_seconds = resumed->header.render_seconds;
        record.resumed_samples = count_samples(resumed->states).total;
        source.states = std::move(resumed->states);
    }
    SteadyRenderer renderer(std::move(source), warn_of_device_failure);
    record.array_map = renderer.array_map();
    record.pipeline_seconds = renderer.pipeline_seconds();
    if (job.messages.verbose) print_details(renderer.device(), scene, record);
    const PixelRect& crop = job.settings.crop;
    const uint32_t held = samples_per_pixel(renderer.states());
    Upkeep upkeep{.checkpoints = {},
                  .images = {},
                  .convergence = Convergence(job.target_error, std::move(reference)),
                  .progress = Progress(uint64_t{crop.width()} * crop.height(), job.target,
                                       double(held) / job.target, job.time_limit,
                                       job.messages.quiet ? ProgressStyle::none : job.messages.progress),
                  .seconds_before = record.render_seconds,
                  .planned = resumed ? resumed->header.planned : 0};
    if (job.checkpoint.file) upkeep.checkpoints.emplace(*job.checkpoint.file, job.checkpoint.every);
    if (job.write_every) upkeep.images.emplace(*job.write_every);

    // Before this line there is nothing to keep, and a signal ends the program at once.
    const InterruptGuard guard;
    const std::optional<Error> failure = trace(renderer, job, guard, upkeep, record);
    const bool interrupted = guard.interrupted() && !record.complete;
    Image image = collect_image(renderer, aovs, record);
    print_outcome(job.messages, record, job.target);
    record.validation_messages = instance.validation_messages().size();
    Attempts attempts;
    if (upkeep.checkpoints) {
        attempts.attempt([&] {
            upkeep.checkpoints->finish(checkpoint_header(record, record.render_seconds, upkeep),
                                       renderer.states());
        });
    }
    attempts.attempt([&] { write_outputs(job.images, report, record, std::move(image)); });
    attempts.attempt([&] {
        if (failure) throw Error(*failure);
    });
    attempts.finish();
    upkeep.progress.end(record.complete ? "done" : interrupted ? "interrupted" : "time limit");
    return interrupted ? ExitCode::interrupted : ExitCode::done;
}

// The files that the command line names.
CommandFiles files_of(const RenderOptions& options) {
    CommandFiles files;
    files.read("SCENE", options.scene_file);
    if (options.reference) files.read("--reference", *options.reference);
    for (const std::string& path : options.images.files)
        files.write("-o", path);
    if (options.report) files.write("--report", *options.report);
    if (options.checkpoint.file) files.write("--checkpoint", *options.checkpoint.file);
    return files;
}

ExitCode render(const RenderOptions& options, const std::string& command_line) {
    CommandFiles files = files_of(options);
    check_outputs(options.images);
    check_report(options.report);
    check_checkpoint(options.checkpoint);

    const auto start = std::chrono::steady_clock::now();
    const MessageOptions& messages = options.messages;
    const ProgressStyle style = messages.quiet ? ProgressStyle::none : messages.progress;
    Scene scene = load_with_progress(options.scene_file, options.loading, style);
    files.read_all("the scene's file", scene.files);
    const double load_seconds = seconds_since(start);
    const RenderJob job = options.job(scene);
    std::optional<Image> reference;
    if (options.reference) reference = load_reference(*options.reference, job.settings);

    warn_of_unseen_lights(scene, job.settings.estimator);
    const GpuScene gpu_scene = build_with_progress(scene, style);
    RenderRecord record{.command_line = command_line,
                        .scene_file = options.scene_file,
                        .scene_attributes = scene.attributes,
                        .identity = make_identity(gpu_scene, job.camera, job.settings),
                        .adaptive = job.adaptive,
                        .camera = job.camera,
                        .settings = job.settings,
                        .primitives = gpu_scene.id_count,
                        .lights = gpu_scene.light_count,
                        .load_seconds = load_seconds,
                        .bvh_seconds = gpu_scene.bvh_seconds,
                        .target_error = job.target_error,
                        .reference = options.reference};

    const vk::Instance instance(instance_options());
    const vk::DeviceInfo device = vk::select_device(instance.devices(), options.device);
    const ExitCode code =
        render_on(instance, device, gpu_scene, job, options.report, std::move(reference), record);
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
error for --sampler independent, and somewhat more than the error where others converge faster. It does not
include light that no sample has found yet. A resumed rendering estimates the error anew, and may take up to
twice as many samples.
--adaptive renders two halves with different seeds. Each takes its samples where the other shows that they
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
