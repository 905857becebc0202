// See viewer.h. One thread does everything: between two submissions to the device it serves the window.
#include "window/viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/printable.h"
#include "image/relative_error.h"
#include "session/next_look.h"
#include "view/pace.h"

namespace candela {
namespace {

// Duration of a submission [s], which is the window's response time.
constexpr double SUBMISSION_SECONDS = 0.03;

// The camera rests when nothing has changed for this long [s]; then the picture gets all its pixels.
constexpr double REST_SECONDS = 0.25;

// How long an idle window waits for input at a time [s].
constexpr double IDLE_SECONDS = 0.1;

// The rate is a mean over about this long [s].
constexpr double RATE_SECONDS = 0.5;

// Settings for the whole of a picture of another size.
RenderSettings resized(RenderSettings settings, uvec2 size) {
    settings.size = size;
    settings.crop = {0, 0, size.x, size.y};
    return settings;
}

}  // namespace

Viewer::Viewer(Window& window, const vk::Instance& instance, Scene scene, ViewState state,
               ViewerOptions options)
    : window_(window),
      instance_(instance),
      scene_(std::move(scene)),
      stages_(scene_),
      state_(std::move(state)),
      options_(std::move(options)),
      gui_(window),
      denoiser_(options_.denoiser),
      next_scale_(FIRST_SCALE) {
    state_.settings.submission_seconds = SUBMISSION_SECONDS;
    state_.settings.aovs = true;  // EXRs hold them.
    if (scene_.environment) {
        radiance_ = scene_.environment->radiance;
        state_.environment_rotation = scene_.environment->rotation;
    }
    for (const std::string& warning : summary_of(gpu_scene_.warnings))
        options_.say("warning: " + warning);
    figures_.device = options_.device.name;
    begin();
}

bool Viewer::ended() const {
    return window_.closing() || (window_.dropped() && !options_.close_at_target) || options_.stopped();
}

bool Viewer::changed_lately() const {
    return seconds_between(last_change_, Clock::now()) < REST_SECONDS;
}

bool Viewer::run() {
    while (true) {
        try {
            if (restart_ || !renderer_) begin();
            const bool complete = accumulate();
            if (complete && scale_ == 1 && options_.close_at_target) return true;
            while (!restart_ && !ended()) {
                frame();
                window_.wait(IDLE_SECONDS);
            }
            if (ended()) return complete && scale_ == 1;
        } catch (const Error& error) {
            recover(error);
        }
    }
}

void Viewer::open() {
    const auto make_surface = [this] { return window_.make_surface(instance_.handle()); };
    device_ = std::make_unique<vk::Device>(instance_, options_.device, options_.pipeline_cache_folder);
    presenter_ = std::make_unique<vk::Presenter>(*device_, make_surface(), make_surface);
    display_ = std::make_unique<Display>(*device_, presenter_->blue_first());
}

// Closes the device; or throws the error, if it is of another kind or the last allowed failure.
void Viewer::recover(const Error& error) {
    const uint64_t samples = copy_.state() ? copy_.state()->total_samples() : 0;
    const bool again = recovery_.survives(error, renderer_ != nullptr, samples);
    if (renderer_) state_.settings.submission_seconds /= 2;
    renderer_.reset();
    denoised_.reset();
    display_.reset();
    presenter_.reset();
    device_.reset();
    if (!again) {
        save_copy();
        throw Error(recovery_.cause());
    }
    const uint32_t kept = copy_.state() && !restart_ ? copy_.state()->min_samples() : 0;
    tell(std::string(error.what()) + "; reopening the device and continuing from " + std::to_string(kept) +
         " samples per pixel");
    recovery_.pause();
}

// Begins the picture that the user wants now or, if only the device has changed, continues the current one.
void Viewer::begin() {
    restart_ |= outdated();
    BufferSet changed;
    if (intensity_ != state_.environment_intensity) {
        intensity_ = state_.environment_intensity;
        for (size_t i = 0; i < radiance_.size(); ++i)
            scene_.environment->radiance[i] = intensity_ * radiance_[i];
        changed = stages_.update(scene_, {.environment = true});
    }
    if (scene_.environment && scene_.environment->rotation != state_.environment_rotation) {
        scene_.environment->rotation = state_.environment_rotation;
        stages_.update(scene_, {.rotation = true});
    }
    if (restart_) {
        copy_.clear();
        denoiser_.clear();
        denoised_.reset();
        denoised_samples_ = 0.0;
        recovery_.forget_progress();
        render_seconds_ = 0.0;
    }
    begun_ = Clock::now();
    moving_ = !copy_.state() && changed_lately();
    scale_ = moving_ ? next_scale_ : 1;
    camera_ = state_.camera;
    settings_ = resized(state_.settings, scaled_size(state_.settings.size, scale_));
    if (!device_) open();
    if (renderer_) {
        renderer_->reset(gpu_scene_, camera_, settings_, changed);
    } else {
        renderer_ = std::make_unique<Renderer>(*device_, gpu_scene_, camera_, settings_);
    }
    if (copy_.state()) renderer_->upload(*copy_.state());
    spp_ = copy_.state() ? copy_.state()->min_samples() : 0;
    figures_.size = settings_.size;
    figures_.device_bytes = device_bytes(gpu_scene_, settings_);
    figures_.samples = spp_;
    figures_.error = copy_.error();
    restart_ = false;
    is_first_ = true;
    measured_from_ = next_draw_ = Clock::now();
    measured_samples_ = double(spp_) * figures_.size.x * figures_.size.y;
}

// Renders until the picture has all samples, or something stops it. Returns whether it has all.
bool Viewer::accumulate() {
    while (spp_ < options_.target) {
        stop_ = scale_ > 1 ? options_.target : next_look(spp_, options_.target, MIN_ESTIMATED_SPP / 2);
        if (!renderer_->render(stop_, [this](double progress) { return step(progress); })) return false;
        spp_ = stop_;
        if (scale_ > 1 || restart_ || ended()) break;
        copy_.estimate_error(*renderer_, spp_, seconds_between(begun_, Clock::now()));
        figures_.error = copy_.error();
        measured_from_ = Clock::now();
    }
    return spp_ == options_.target;
}

void Viewer::measure(double progress) {
    const double pixels = double(figures_.size.x) * figures_.size.y;
    const double samples = std::round((spp_ + progress * (stop_ - spp_)) * pixels);  // Samples are whole.
    figures_.samples = samples / pixels;
    const double seconds = seconds_between(measured_from_, Clock::now());
    render_seconds_ += seconds;
    if (seconds <= 0.0) return;
    const double rate = (samples - measured_samples_) / seconds;
    double& mean = figures_.samples_per_second;
    mean = mean == 0.0 ? rate : mean + (rate - mean) * std::min(1.0, seconds / RATE_SECONDS);
    measured_samples_ = samples;
}

// Called between submissions. Returns whether the device should continue.
bool Viewer::step(double progress) {
    measure(progress);
    window_.poll();
    const bool whole = figures_.samples >= 1.0;
    // A moving picture always gets its first samples, however fast the user moves.
    if (moving_ && !whole) return !ended();
    if (moving_ && is_first_) next_scale_ = next_scale(scale_, seconds_between(begun_, Clock::now()));
    is_first_ = false;
    if (scale_ == 1 && copy_.due()) copy_.take(*renderer_);
    if (window_.take_activity() || Clock::now() >= next_draw_) frame();
    while (state_.paused && whole && !restart_ && !ended()) {
        window_.wait(IDLE_SECONDS);
        frame();
    }
    measured_from_ = Clock::now();
    return !restart_ && !ended();
}

std::pair<Scene, ViewState> Viewer::leave() && {
    if (scene_.environment) {
        scene_.environment->radiance = std::move(radiance_);
        scene_.environment->rotation = state_.environment_rotation;
    }
    return {std::move(scene_), std::move(state_)};
}

// Whether the picture in progress is outdated.
bool Viewer::outdated() const {
    const RenderSettings& wanted = state_.settings;
    return state_.camera != camera_ || scaled_size(wanted.size, scale_) != settings_.size ||
           wanted.estimator != settings_.estimator || wanted.max_depth != settings_.max_depth ||
           state_.environment_rotation != gpu_scene_.environment_rotation ||
           state_.environment_intensity != intensity_;
}

void Viewer::note_changes() {
    if (!outdated()) return;
    last_change_ = Clock::now();
    restart_ = true;
}

}  // namespace candela
