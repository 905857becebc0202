// See viewer.h. The window between two submissions.
#include <algorithm>
#include <cstdio>
#include <deque>
#include <string>

#include "base/printable.h"
#include "shared/constants.h"
#include "vk/transfer.h"
#include "window/controls.h"
#include "window/panel.h"
#include "window/viewer.h"

namespace candela {
namespace {

// Drawing may use this fraction of the time, unless the user acts.
constexpr double DRAWING_FRACTION = 0.1;

// After a pause, the camera flies no farther than in this time [s].
constexpr double LONGEST_FRAME = 0.1;

// Makes the image an accumulation whose means are these planes.
void upload_mean(const vk::StorageImage& image, const RgbPlanes& rgb) {
    const size_t pixels = rgb[0].size();
    std::vector<float> layers(pixels * vk::StorageImage::CHANNELS * 2);
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 0; c < 3; ++c)
            layers[4 * i + c] = rgb[c][i];
        layers[4 * (pixels + i) + 3] = 1.0f;  // Samples.
    }
    static_assert(LAYER_L == 0 && LAYER_L_COMPENSATION == 1);
    vk::upload(image, LAYER_L, layers);
}

}  // namespace

// Handles all input, and shows the result. After a change of the picture, only motions are handled until a
// new picture has begun, so that a file saved next shows the change.
void Viewer::frame() {
    const Clock::time_point start = Clock::now();
    frame_seconds_ = std::min(seconds_between(last_frame_, start), LONGEST_FRAME);
    last_frame_ = start;
    const uvec2 size = window_.size();
    const bool visible = size.x > 0 && size.y > 0;
    if (visible && !options_.close_at_target) state_.settings.size = size;
    note_changes();
    gui_.begin_frame();
    std::deque<Input>& inputs = window_.inputs();
    while (!inputs.empty() && (!restart_ || is_motion(inputs.front()))) {
        const Input input = inputs.front();
        inputs.pop_front();
        turn(&input);
        if (!is_motion(input)) turn(nullptr);  // Only then does Dear ImGui say that typing has ended.
    }
    controls_.fly(state_.camera, frame_seconds_);
    turn(nullptr);
    if (scale_ > 1 && !changed_lately()) restart_ = true;  // The camera rests.
    update_title();
    if (visible) {
        denoise();
        display_->draw(shown(), size, state_.tonemap, state_.exposure_ev, gui_.draw(size));
        presenter_->show(display_->screen(), size.x, size.y);
    }
    next_draw_ = later(Clock::now(), seconds_between(start, Clock::now()) / DRAWING_FRACTION);
}

// What the window shows.
const vk::StorageImage& Viewer::shown() {
    return state_.denoise && denoised_ ? *denoised_ : renderer_->accumulation();
}

// Takes over what has been denoised, and begins the next run on a picture at rest that has more samples. A
// failure is told, and turns the switch off.
void Viewer::denoise() {
    if (!state_.denoise || scale_ > 1 || restart_) return;
    try {
        if (denoiser_.take()) {
            const Image& image = *denoiser_.picture();
            if (!denoised_) {
                denoised_ = std::make_unique<vk::StorageImage>(
                    vk::make_storage_image(*device_, image.data.width(), image.data.height(),
                                           LAYER_L_COMPENSATION + 1, "denoised picture"));
            }
            upload_mean(*denoised_, image.find_rgb("Denoised").value());
        }
        if (figures_.samples >= 1.0 && figures_.samples > denoised_samples_ && denoiser_.due()) {
            denoised_samples_ = figures_.samples;
            denoiser_.begin(renderer_->download());
        }
    } catch (const Error& error) {
        state_.denoise = false;
        tell("the picture stays noisy: " + std::string(error.what()));
    }
}

// One turn of the user interface: the mouse and keys, then the panel.
void Viewer::turn(const Input* input) {
    gui_.begin_turn(input);
    ViewRequests requests = controls_.apply(input, state_, frame_seconds_);
    if (state_.panel && options_.start_page) {
        show_start_page(figures_);
    } else if (state_.panel) {
        show_panel(state_, requests, figures_, scene_.cameras, scene_.environment.has_value());
    }
    gui_.end_turn();
    apply(requests);
    note_changes();
}

void Viewer::apply(const ViewRequests& requests) {
    if (requests.close) window_.close();
    if (requests.camera) state_.home = scene_.cameras.at(*requests.camera);
    if (requests.camera || requests.home) state_.camera = state_.home;
    if (requests.focus) set_focus(*requests.focus);
    if (requests.restart) restart_ = true;
    save_as_asked(requests);
}

void Viewer::set_focus(vec2 place) {
    if (state_.camera.ortho_height || state_.camera.panorama) {
        tell("this camera is sharp everywhere");
        return;
    }
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

void Viewer::update_title() {
    std::string title = printable(options_.name, MAX_NAME_BYTES) + ": " +
                        std::to_string(uint32_t(figures_.samples)) + " samples per pixel";
    if (figures_.error) {
        char text[48];
        std::snprintf(text, sizeof text, ", estimated error %.2f %%", 100.0 * *figures_.error);
        title += text;
    }
    window_.set_title(title + (scale_ > 1 ? ", moving" : state_.paused ? ", paused" : ""));
}

void Viewer::tell(const std::string& message) {
    figures_.message = printable(message, MAX_MESSAGE_BYTES);
    options_.say(message);
}

}  // namespace candela
