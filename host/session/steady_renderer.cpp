// See steady_renderer.h.
#include "session/steady_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace candela {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Copying the state may use this fraction of the time.
static constexpr double LARGEST_FRACTION_OF_HOLDING = 0.05;

SteadyRenderer::SteadyRenderer(Source source, OnFailure on_failure)
    : source_(std::move(source)), on_failure_(std::move(on_failure)) {
    compiled_before_ = device().programs().compiled();
    open();
    look_up_first_hits();
    next_copy_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(source_.copy_seconds));
}

void SteadyRenderer::open() {
    source_.settings.seed = state().seed;
    renderer_ =
        std::make_unique<Renderer>(source_.device->open(), *source_.scene, *source_.camera, source_.settings);
    renderer_->upload(state());
    array_map_ = renderer_->array_map();
    pipeline_seconds_ = renderer_->pipeline_seconds();
    pipeline_cpu_seconds_ = renderer_->pipeline_cpu_seconds();
    loaded_ = true;
}

void SteadyRenderer::load(const BufferSet& changed) {
    source_.settings.seed = state().seed;
    renderer_->reset(*source_.scene, *source_.camera, source_.settings, changed);
    renderer_->upload(state());
    array_map_ = renderer_->array_map();
    pipeline_seconds_ = renderer_->pipeline_seconds();
    pipeline_cpu_seconds_ = renderer_->pipeline_cpu_seconds();
    loaded_ = true;
}

void SteadyRenderer::look_up_first_hits() {
    if (source_.positions && positions_.empty()) positions_ = renderer_->positions();
    if (source_.distances && distances_.empty()) distances_ = renderer_->distances();
    if (source_.coverage && coverage_.pixel_count() == 0)
        coverage_ = renderer_->coverage(*source_.scene, source_.keep_going);
    if (source_.motion != nullptr && *source_.motion && motion_.empty())
        motion_ = renderer_->motion(*source_.scene, *source_.camera, **source_.motion);
}

void SteadyRenderer::restart(const BufferSet& changed, const RenderSettings& settings,
                             std::vector<Accumulation> states) {
    source_.settings = settings;
    source_.states = std::move(states);
    positions_.clear();
    distances_.clear();
    coverage_ = {};
    motion_.clear();
    selected_ = 0;
    recovery_ = {};
    if (changed.all()) renderer_.reset();  // Before the next one takes memory.
    compiled_before_ = device().programs().compiled();
    renderer_ ? load(changed) : open();
    look_up_first_hits();
}

void SteadyRenderer::select(size_t state) {
    selected_ = state;
    loaded_ = false;
}

void SteadyRenderer::set_latency(double seconds) {
    source_.settings.latency = seconds;
    if (renderer_) renderer_->set_latency(seconds);
}

void SteadyRenderer::copy_state() {
    const Clock::time_point start = Clock::now();
    state() = renderer_->download();
    const Clock::time_point now = Clock::now();
    const Seconds pause =
        std::max(Seconds(source_.copy_seconds), Seconds(now - start) / LARGEST_FRACTION_OF_HOLDING);
    next_copy_ = now + std::chrono::duration_cast<Clock::duration>(pause);
}

bool SteadyRenderer::render(uint32_t target, const std::function<bool(double)>& keep_going) {
    while (true) {
        try {
            if (!renderer_) open();
            if (!loaded_) load();
            look_up_first_hits();
            const double before = double(std::min(state().min_samples(), target)) / target;
            const bool complete = renderer_->render(target, [&](double done) {
                if (Clock::now() >= next_copy_) copy_state();
                return keep_going(before + (1.0 - before) * done);
            });
            const bool is_hurried = std::isfinite(source_.settings.latency);
            if (complete || !is_hurried)
                copy_state();
            else
                loaded_ = false;
            return complete;
        } catch (const Error& error) {
            recover(error);
        }
    }
}

// Closes the device; or throws the error, if it is of another kind or the last allowed failure.
void SteadyRenderer::recover(const Error& error) {
    const SampleCounts samples = count_samples(source_.states);
    const bool again = recovery_.survives(error, renderer_ != nullptr, samples.total);
    if (renderer_) source_.settings.submission_seconds = renderer_->submission_seconds() / 2;
    renderer_.reset();
    source_.device->close();
    compiled_before_ = 0;
    if (!again) throw Error(recovery_.cause());
    on_failure_(error, samples.min, source_.settings.submission_seconds);
    recovery_.pause();
}

}  // namespace candela
