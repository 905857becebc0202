// See rendering.h.
#include "session/rendering.h"

#include <ctime>
#include <utility>

#include "film/id_layers.h"
#include "session/adaptive.h"

namespace candela {
namespace {

// The states to begin with.
std::vector<Accumulation> first_states(const RenderJob& job, std::optional<Checkpoint>& resumed) {
    if (resumed) return std::move(resumed->states);
    if (job.adaptive) return adaptive_states(job.settings);
    return {empty_state(job.settings)};
}

void add_motion(Image& image, const std::vector<vec2>& motion) {
    for (const auto& [name, axis] : {std::pair("Motion.X", 0), std::pair("Motion.Y", 1)}) {
        std::vector<float>& values = image.add(name).values;
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = motion[i][axis];
    }
}

}  // namespace

Rendering::Rendering(Source source, RenderJob job, RenderRecord record)
    : scene_(source.scene),
      device_(source.device),
      job_(std::move(job)),
      record_(std::move(record)),
      renderer_({.device = source.device,
                 .scene = source.scene,
                 .camera = &job_.camera,
                 .settings = job_.settings,
                 .states = first_states(job_, source.resumed),
                 .positions = job_.aovs.needs_positions(),
                 .distances = job_.aovs.distance,
                 .coverage = job_.aovs.needs_coverage(),
                 .keep_going = std::move(source.keep_going),
                 .motion = &job_.motion},
                [this](const Error& error, uint32_t kept, double submission_seconds) {
                    callbacks_.device_failed(error, kept, submission_seconds);
                }),
      convergence_(job_.target_error, std::move(source.reference)),
      seconds_before_(source.resumed ? source.resumed->header.render_seconds : 0.0),
      planned_(source.resumed ? source.resumed->header.planned : 0) {
    record_.resumed_samples = count_samples(renderer_.states()).total;
    complete_record();
    if (job_.checkpoint.file) checkpoints_.emplace(*job_.checkpoint.file, job_.checkpoint.every);
    if (job_.write_every) images_.emplace(*job_.write_every);
}

void Rendering::restart(RenderJob job, RenderRecord record, const BufferSet& changed) {
    job_ = std::move(job);
    record_ = std::move(record);
    std::optional<Checkpoint> none;
    renderer_.restart(changed, job_.settings, first_states(job_, none));
    convergence_ = Convergence(job_.target_error, {});
    seconds_before_ = 0.0;
    planned_ = 0;
    complete_record();
}

void Rendering::set_target(const RenderJob& job) {
    job_.target = job.target;
    job_.time_limit = job.time_limit;
    renderer_.set_latency(job.settings.latency);
    if (job.target_error == job_.target_error) return;
    job_.target_error = job.target_error;
    record_.target_error = job.target_error;
    convergence_ = Convergence(job.target_error, {});
}

// Notes what the device says.
void Rendering::complete_record() {
    record_.maker = make_maker(device_->info());
    record_.device_bytes = device_bytes(*scene_, job_.settings);
    record_.array_map = renderer_.array_map();
    record_.kernels_compiled = renderer_.kernels_compiled();
    const bool has_compiled = record_.kernels_compiled > 0;
    record_.pipeline_seconds = has_compiled ? renderer_.pipeline_seconds() : 0.0;
    record_.pipeline_cpu_seconds = has_compiled ? renderer_.pipeline_cpu_seconds() : 0.0;
}

double Rendering::seconds_of_run() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

CheckpointHeader Rendering::checkpoint_header() const {
    return {.identity = record_.identity,
            .maker = record_.maker,
            .render_seconds = record_.render_seconds,
            .planned = planned_};
}

Image Rendering::collect_image(RenderRecord& record) const {
    const std::span<const Accumulation> states = renderer_.states();
    const SampleCounts counts = count_samples(states);
    record.samples = counts.total;
    record.spp = samples_per_pixel(states, counts);
    record.max_spp = counts.max;
    Image image = make_image(states, job_.aovs, renderer_.positions());
    if (job_.aovs.distance) image.add("Depth.V").values = renderer_.distances();
    if (job_.aovs.needs_coverage()) add_id_layers(image, job_.aovs, renderer_.coverage(), *job_.labels);
    if (job_.aovs.motion) add_motion(image, renderer_.motion());
    return image;
}

Image Rendering::image() {
    return collect_image(record_);
}

void Rendering::finish_checkpoint() const {
    if (checkpoints_) checkpoints_->finish(checkpoint_header(), renderer_.states());
}

// Writes a checkpoint and the images if they are due.
void Rendering::keep() {
    if (checkpoints_ && checkpoints_->due()) {
        renderer_.copy_state();
        record_.render_seconds = seconds();
        checkpoints_->write(checkpoint_header(), renderer_.states(), callbacks_.warn);
    }
    if (images_ && images_->over()) {
        renderer_.copy_state();
        RenderRecord current = record_;
        current.render_seconds = seconds();
        Image image = collect_image(current);
        callbacks_.write(current, std::move(image));
        images_->restart();
    }
}

// What is done between submissions. Returns whether to go on.
bool Rendering::step(double done) {
    callbacks_.progress(done, convergence_.estimate());
    keep();
    return callbacks_.keep_going() && !(job_.time_limit && seconds_of_run() >= *job_.time_limit);
}

// Renders until all samples are there, the error is small enough or step() returns false; returns false only
// in the last case. Measures the error at fixed numbers of samples, or not at all if nothing needs it.
bool Rendering::render_and_look() {
    const uint32_t target = job_.target;
    uint32_t held = spp();
    if (held > 0) convergence_.measure(renderer_.states(), seconds());
    while (held < target && !convergence_.reached()) {
        const uint32_t next = job_.adaptive ? next_pass_end(held, target) : convergence_.next(held, target);
        const auto update = [&](double done) { return step(done * next / target); };
        const bool complete =
            job_.adaptive ? render_pass(renderer_, next, planned_, update) : renderer_.render(next, update);
        if (!complete) return false;
        held = next;
        convergence_.measure(renderer_.states(), seconds());
        callbacks_.progress(double(held) / target, convergence_.estimate());
    }
    return true;
}

std::optional<Error> Rendering::run(RenderCallbacks callbacks) {
    callbacks_ = std::move(callbacks);
    const std::clock_t cpu_start = std::clock();
    start_ = std::chrono::steady_clock::now();
    std::optional<Error> failure;
    try {
        record_.complete = render_and_look();
    } catch (const Error& error) {
        if (count_samples(renderer_.states()).total == 0) throw;
        failure = error;
    }
    record_.render_seconds = seconds();
    seconds_before_ = record_.render_seconds;
    record_.cpu_seconds = double(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    record_.counters = total_counters(renderer_.states());
    record_.device_failures = renderer_.failures();
    record_.convergence = convergence_.points();
    record_.estimated_error = convergence_.estimate();
    return failure;
}

}  // namespace candela
