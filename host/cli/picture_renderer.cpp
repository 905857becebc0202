// See picture_renderer.h.
#include "cli/picture_renderer.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "base/caught_error.h"
#include "base/cpu_time.h"
#include "cli/console.h"
#include "cli/label_attributes.h"
#include "cli/outputs.h"
#include "cli/vulkan.h"
#include "film/identity.h"
#include "session/checkpoints.h"

namespace candela {
namespace {

// `, estimated error 0.0183 (target 0.02)`, or nothing.
std::string error_text(const RenderRecord& record) {
    if (!record.target_error) return "";
    return ", estimated error " + (record.estimated_error ? fixed(*record.estimated_error, 4) : "unknown") +
           " (target " + fixed(*record.target_error, 4) + ')';
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

}  // namespace

PictureRenderer::PictureRenderer(const RenderOptions& options, bool is_batch, std::string command_line)
    : options_(options), is_batch_(is_batch), command_line_(std::move(command_line)) {}

void PictureRenderer::choose_device() {
    if (device_) return;
    instance_.emplace(instance_options());
    device_.emplace(*instance_, vk::select_device(instance_->devices(), options_.rendering.device.name),
                    pipeline_cache_folder());
}

const vk::Device& PictureRenderer::denoising_device() {
    if (!denoising_device_) denoising_device_.emplace(*instance_, device_->info(), pipeline_cache_folder());
    return denoising_device_->open();
}

// What --verbose adds before rendering.
void PictureRenderer::print_details(const GpuScene& scene) const {
    const RenderRecord& record = rendering_->record();
    const vk::Device& device = rendering_->device();
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

// `name` begins each message.
void PictureRenderer::print_outcome(const RenderRecord& record, uint32_t target,
                                    const std::string& name) const {
    if (record.counters.nonfinite_samples > 0) {
        print_warning(name + std::to_string(record.counters.nonfinite_samples) +
                      " sample(s) were not finite; they are treated as black");
    }
    if (record.counters.depth_limit_hits > 0) {
        print_warning(name + std::to_string(record.counters.depth_limit_hits) +
                      " path(s) were cut off after " + std::to_string(DEPTH_SAFETY_LIMIT) +
                      " bounces (some hundred or thousand where media scatter); the light that they would "
                      "have found is missing");
    }
    if (record.spp == 0)
        print_warning(name + "stopped before every pixel had a sample; pixels without one are black");
    if (record.target_error && record.complete &&
        !(record.estimated_error && *record.estimated_error <= *record.target_error)) {
        print_warning(name + "the target error was not reached with " + std::to_string(target) +
                      " samples per pixel; allow more (--spp)");
    }
    if (options_.messages.quiet || options_.messages.progress == ProgressStyle::json) return;
    const std::string of_target = record.complete ? "" : " of " + std::to_string(target);
    const double rate = double(record.samples) / std::max(record.render_seconds, 1e-9);
    print_note(name + "rendered " + std::to_string(record.spp) + of_target + " spp in " +
               duration_text(record.render_seconds) + " (" + fixed(rate / 1e6, 2) + " Msamples/s)" +
               error_text(record));
}

RenderRecord PictureRenderer::record_of(const PreparedScene& scene, const RenderJob& job) const {
    RenderRecord record = make_record(scene.scene, scene.records, scene.arrays_hash, job);
    record.command_line = command_line_;
    record.scene_file = scene.file;
    record.load_seconds = scene.load_seconds;
    record.reference = options_.outputs.reference;
    return record;
}

// Makes rendering_ one of the picture.
void PictureRenderer::start(const PreparedScene& scene, const PreparedPicture& picture) {
    const RenderJob& job = *picture.job;
    RenderRecord record = record_of(scene, job);
    const BufferSet changed = changed_buffers(records_, scene.records);
    records_ = scene.records;
    if (rendering_) {
        rendering_->restart(job, std::move(record), changed);
        return;
    }
    std::optional<Checkpoint> resumed = resume(job, record, device_->info(), options_.messages);
    rendering_ = std::make_unique<Rendering>(Rendering::Source{.device = &*device_,
                                                               .scene = &records_,
                                                               .resumed = std::move(resumed),
                                                               .reference = picture.reference,
                                                               .keep_going = [this] { return goes_on(); }},
                                             job, std::move(record));
}

RenderedPicture PictureRenderer::run(const PreparedScene& scene, const PreparedPicture& picture) {
    start(scene, picture);
    const RenderJob& job = *picture.job;
    if (options_.messages.verbose) print_details(scene.records);
    // What messages about it begin with, if there are others.
    const std::string name = is_batch_ ? picture.picture.files.front() + ": " : "";
    const PixelRect& crop = job.settings.crop;
    auto progress = std::make_unique<Progress>(
        uint64_t{crop.width()} * crop.height(), job.target, double(rendering_->spp()) / job.target,
        job.time_limit, options_.messages.progress_style(), is_batch_ ? picture.picture.files.front() : "");
    // Before this line there is nothing to keep, and a signal ends the program at once.
    if (!interrupts_) interrupts_.emplace();
    const ImageOutputs outputs = options_.outputs.images.renamed(picture.picture.files);
    std::optional<Error> failure = rendering_->run(
        {.progress = [&](double done, std::optional<double> error) { progress->update(done, error); },
         .keep_going = [&] { return goes_on(); },
         .warn = [&](const std::string& warning) { print_warning(name + warning); },
         .device_failed =
             [&](const Error& error, uint32_t kept, double submission_seconds) {
                 print_warning(name + error.what() + "; reopening the device and continuing from " +
                               std::to_string(kept) + " samples per pixel in submissions of " +
                               fixed(1e3 * submission_seconds, 3) + " ms");
             },
         .write =
             [&](const RenderRecord& current, Image image) {
                 if (job.labels) add_label_attributes(image, *job.labels);
                 write_current_images(outputs, current, std::move(image));
             }});
    progress->clear();
    const bool complete = rendering_->record().complete;
    const char* const state = complete               ? "done"
                              : interrupts_->noted() ? "interrupted"
                              : time_is_over()       ? "left out"
                                                     : "time limit";
    if (is_batch_ && failure) throw Error(*failure);

    Image image = rendering_->image();
    if (job.labels) add_label_attributes(image, *job.labels);
    RenderedPicture rendered{.picture = picture.picture,
                             .record = rendering_->record(),
                             .image = std::move(image),
                             .state = state,
                             .progress = std::move(progress),
                             .failure = std::move(failure)};
    rendered.record.validation_messages = instance_->validation_messages().size();
    print_outcome(rendered.record, job.target, name);
    rendered.attempts.attempt([&] { rendering_->finish_checkpoint(); });
    return rendered;
}

RenderedPicture PictureRenderer::render(const PreparedScene& scene, const PreparedPicture& picture) {
    const CpuWatch watch;
    try {
        RenderedPicture rendered = run(scene, picture);
        const double kernels = rendered.record.pipeline_cpu_seconds;
        rendered.overhead = {
            .scene = scene.cpu_seconds, .kernels = kernels, .host = watch.seconds() - kernels};
        return rendered;
    } catch (...) {
        const Error error = caught_error();
        rendering_.reset();
        // What the device holds is in order if it has just no room for more.
        if (error.kind() != ErrorKind::out_of_memory) device_->close();
        throw Error(error);
    }
}

bool PictureRenderer::time_is_over() const {
    const std::optional<double>& limit = options_.list.batch_time;
    return limit &&
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() >= *limit;
}

void PictureRenderer::check_validation() const {
    if (instance_) candela::check_validation(*instance_);
}

}  // namespace candela
