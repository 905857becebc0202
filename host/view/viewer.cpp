// See viewer.h. One thread does everything: between two submissions to the device it looks after the window.
#include "view/viewer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"
#include "view/camera_control.h"
#include "view/controls.h"
#include "view/pace.h"
#include "view/panel.h"

namespace candela {
namespace {

// How long a submission should take [s]: so soon the window hears its user.
constexpr double SUBMISSION_SECONDS = 0.03;

// The camera rests when nothing has changed for so long [s]; then the picture gets all its pixels.
constexpr double REST_SECONDS = 0.25;

// How long a window with nothing to do waits for its user at a time [s].
constexpr double IDLE_SECONDS = 0.1;

// So long after the user did something [s] the window is drawn after every submission: what the panel opens
// takes several drawings to appear.
constexpr double LIVELY_SECONDS = 0.5;

// Otherwise drawing and estimating the error may take these shares of the time, and the error is estimated
// once a second.
constexpr double DRAWING_SHARE = 0.1;
constexpr double ERROR_SHARE = 0.02;
constexpr double ERROR_SECONDS = 1.0;

// The rate is a mean over about so long [s].
constexpr double RATE_SECONDS = 0.5;

// After a pause the camera flies no farther than in so long [s].
constexpr double LONGEST_FRAME = 0.1;

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

std::chrono::steady_clock::time_point later(std::chrono::steady_clock::time_point when, double seconds) {
    return when + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                      std::chrono::duration<double>(seconds));
}

// Settings for the whole of a picture of another size.
RenderSettings resized(RenderSettings settings, uvec2 size) {
    settings.size = size;
    settings.crop = {0, 0, size.x, size.y};
    return settings;
}

}  // namespace

Viewer::Viewer(Window& window, const vk::Device& device, vk::Presenter presenter, Scene scene,
               ViewState state, ViewerOptions options)
    : window_(window),
      device_(device),
      presenter_(std::move(presenter)),
      scene_(std::move(scene)),
      gpu_scene_(build_gpu_scene(scene_)),
      state_(std::move(state)),
      options_(std::move(options)),
      home_(state_.camera),
      gui_(window),
      display_(device, presenter_.blue_first()),
      next_scale_(FIRST_SCALE) {
    state_.settings.submission_seconds = SUBMISSION_SECONDS;
    if (scene_.environment) {
        radiance_ = scene_.environment->radiance;
        state_.environment_rotation = scene_.environment->rotation;
    }
    renderer_ = std::make_unique<Renderer>(device_, gpu_scene_, state_.camera, state_.settings);
    figures_.device = device.info().name;
}

bool Viewer::ended() const {
    return window_.closing() || options_.stopped();
}

bool Viewer::changed_lately() const {
    return seconds_between(last_change_, Clock::now()) < REST_SECONDS;
}

bool Viewer::run() {
    while (true) {
        begin();
        const bool complete =
            renderer_->render(options_.target, [this](double progress) { return step(progress); });
        if (complete && scale_ == 1 && options_.close_at_target) return true;
        while (!restart_ && !ended()) {
            frame();
            window_.wait(IDLE_SECONDS);
        }
        if (ended()) return complete && scale_ == 1;
    }
}

// Clears the picture and sets the renderer to what the user wants by now.
void Viewer::begin() {
    if (rebuild_) {
        for (size_t i = 0; i < radiance_.size(); ++i)
            scene_.environment->radiance[i] = state_.environment_intensity * radiance_[i];
        gpu_scene_ = build_gpu_scene(scene_);
        renderer_.reset();  // Before the next one takes memory.
        renderer_ = std::make_unique<Renderer>(device_, gpu_scene_, state_.camera, state_.settings);
    }
    begun_ = Clock::now();
    moving_ = changed_lately();
    scale_ = moving_ ? next_scale_ : 1;
    gpu_scene_.environment_rotation = state_.environment_rotation;
    const RenderSettings settings = resized(state_.settings, scaled_size(state_.settings.size, scale_));
    renderer_->reset(gpu_scene_, state_.camera, settings);
    figures_.size = settings.size;
    figures_.device_bytes = device_bytes(gpu_scene_, settings);
    figures_.samples = 0.0;
    figures_.error.reset();
    restart_ = rebuild_ = false;
    is_first_ = true;
    measured_from_ = next_draw_ = Clock::now();
    measured_samples_ = 0.0;
}

void Viewer::measure(double progress) {
    const double pixels = double(figures_.size.x) * figures_.size.y;
    const double samples = std::round(progress * pixels * options_.target);  // There are no halves.
    figures_.samples = samples / pixels;
    const double seconds = seconds_between(measured_from_, Clock::now());
    if (seconds <= 0.0) return;
    const double rate = (samples - measured_samples_) / seconds;
    double& mean = figures_.samples_per_second;
    mean = mean == 0.0 ? rate : mean + (rate - mean) * std::min(1.0, seconds / RATE_SECONDS);
    measured_samples_ = samples;
}

// Called between submissions. Returns whether the device shall go on.
bool Viewer::step(double progress) {
    measure(progress);
    window_.poll();
    const bool whole = figures_.samples >= 1.0;
    // A moving picture first becomes whole, however fast the user moves.
    if (moving_ && !whole) return !ended();
    if (moving_ && is_first_) next_scale_ = next_scale(scale_, seconds_between(begun_, Clock::now()));
    is_first_ = false;
    if (window_.take_activity()) last_activity_ = Clock::now();
    const bool lively = seconds_between(last_activity_, Clock::now()) < LIVELY_SECONDS;
    if (lively || Clock::now() >= next_draw_) frame();
    while (state_.paused && whole && !restart_ && !ended()) {
        window_.wait(IDLE_SECONDS);
        frame();
    }
    measured_from_ = Clock::now();
    return !restart_ && !ended();
}

// One turn of the user interface: what the user did, the panel, and what is on the screen.
void Viewer::frame() {
    const Clock::time_point start = Clock::now();
    const double seconds = std::min(seconds_between(last_frame_, start), LONGEST_FRAME);
    last_frame_ = start;
    const ViewState before = state_;
    gui_.begin();
    ViewRequests requests = apply_controls(window_, state_, seconds);
    if (state_.panel) {
        show_panel(state_, requests, figures_, scene_.cameras, home_, scene_.environment.has_value());
    }
    const uvec2 size = window_.size();
    const Overlay& overlay = gui_.end(size);
    apply(requests);
    note_changes(before);
    update_figures();
    if (size.x > 0 && size.y > 0) {
        display_.draw(renderer_->accumulation(), size, state_.tonemap, state_.exposure_ev, overlay);
        presenter_.show(display_.screen(), size.x, size.y);
    }
    next_draw_ = later(Clock::now(), seconds_between(start, Clock::now()) / DRAWING_SHARE);
}

void Viewer::apply(const ViewRequests& requests) {
    if (requests.close) window_.close();
    if (requests.camera) home_ = scene_.cameras.at(*requests.camera);
    if (requests.camera || requests.home) state_.camera = home_;
    if (requests.focus) set_focus(*requests.focus);
    if (requests.restart) restart_ = true;
    if (requests.save_png) save_as_next(".png", [this](const std::string& path) { save(path); });
    if (requests.save_exr) save_as_next(".exr", [this](const std::string& path) { save(path); });
    if (requests.save_camera) {
        save_as_next("-camera.json", [this](const std::string& path) {
            write_file_atomically(path, camera_json(state_.camera, "view"));
        });
    }
}

void Viewer::set_focus(vec2 place) {
    const uvec2 size = figures_.size;
    const uvec2 pixel = min(uvec2(max(place, 0.0f) * vec2(size)), size - 1u);
    const float depth = renderer_->positions()[4 * (size_t(pixel.y) * size.x + pixel.x) + 3];
    if (depth == INFINITE) {
        tell("there is nothing to focus on");
        return;
    }
    state_.camera.lens.focal_distance = depth;
    char text[48];
    std::snprintf(text, sizeof text, "focus at %.4g m", double(depth));
    tell(text);
}

// Decides what must begin anew.
void Viewer::note_changes(const ViewState& before) {
    const uvec2 size = window_.size();
    if (!options_.close_at_target && size.x > 0 && size.y > 0 && size != state_.settings.size) {
        state_.settings = resized(state_.settings, size);
    }
    const RenderSettings& a = before.settings;
    const RenderSettings& b = state_.settings;
    rebuild_ |= before.environment_intensity != state_.environment_intensity;
    const bool changed = rebuild_ || before.camera != state_.camera || a.size != b.size ||
                         a.estimator != b.estimator || a.max_depth != b.max_depth ||
                         before.environment_rotation != state_.environment_rotation;
    if (changed) last_change_ = Clock::now();
    if (changed || (scale_ > 1 && !changed_lately())) restart_ = true;
}

void Viewer::update_figures() {
    const Clock::time_point start = Clock::now();
    if (figures_.samples >= 2.0 && scale_ == 1 && !restart_ && start >= next_error_) {
        figures_.error = relative_error(renderer_->download());
        const double seconds = seconds_between(start, Clock::now());
        next_error_ = later(Clock::now(), std::max(ERROR_SECONDS, seconds / ERROR_SHARE));
    }
    const std::string state = scale_ > 1 ? ", moving" : state_.paused ? ", paused" : "";
    window_.set_title(options_.name + ": " + std::to_string(uint32_t(figures_.samples)) +
                      " samples per pixel" + state);
}

void Viewer::save(const std::filesystem::path& path) {
    const Accumulation state = renderer_->download();
    if (image_format(path) == ImageFormat::png) {
        const Image image = make_image(state, {}, {});
        write_png(path, state.rect.width(), state.rect.height(),
                  develop(image, state_.tonemap, state_.exposure_ev));
    } else {
        const AovSelection aovs{.position = true, .depth = true, .variance = true, .sample_count = true};
        write_exr(path, make_image(state, aovs, renderer_->positions()));
    }
}

// Writes to the first file NAME-1, NAME-2, ... that is not there yet. A failure is told; the user may try
// again.
void Viewer::save_as_next(const std::string& extension,
                          const std::function<void(const std::string&)>& write) {
    std::string path;
    uint32_t number = 0;
    do {
        path = options_.name + "-" + std::to_string(++number) + extension;
    } while (std::filesystem::exists(path));
    try {
        write(path);
        tell("wrote " + path);
    } catch (const Error& error) {
        tell(error.what());
    }
}

void Viewer::tell(const std::string& message) {
    figures_.message = message;
    options_.say(message);
}

}  // namespace candela
