// See viewer.h. What the user sees and does between two submissions.
#include <algorithm>
#include <cstdio>
#include <string>

#include "view/controls.h"
#include "view/panel.h"
#include "view/viewer.h"

namespace candela {
namespace {

// Drawing may take this share of the time, unless the user does something.
constexpr double DRAWING_SHARE = 0.1;

// After a pause the camera flies no farther than in so long [s].
constexpr double LONGEST_FRAME = 0.1;

}  // namespace

// One turn of the user interface: what the user did, the panel, and what is on the screen.
void Viewer::frame() {
    const Clock::time_point start = Clock::now();
    const double seconds = std::min(seconds_between(last_frame_, start), LONGEST_FRAME);
    last_frame_ = start;
    gui_.begin();
    ViewRequests requests = apply_controls(window_, state_, seconds);
    if (state_.panel) {
        show_panel(state_, requests, figures_, scene_.cameras, home_, scene_.environment.has_value());
    }
    const uvec2 size = window_.size();
    const Overlay& overlay = gui_.end(size);
    apply(requests);
    note_changes();
    update_title();
    if (size.x > 0 && size.y > 0) {
        display_->draw(renderer_->accumulation(), size, state_.tonemap, state_.exposure_ev, overlay);
        presenter_->show(display_->screen(), size.x, size.y);
    }
    next_draw_ = later(Clock::now(), seconds_between(start, Clock::now()) / DRAWING_SHARE);
}

void Viewer::apply(const ViewRequests& requests) {
    if (requests.close) window_.close();
    if (requests.camera) home_ = scene_.cameras.at(*requests.camera);
    if (requests.camera || requests.home) state_.camera = home_;
    if (requests.focus) set_focus(*requests.focus);
    if (requests.restart) restart_ = true;
    save_as_asked(requests);
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

void Viewer::update_title() {
    std::string title =
        options_.name + ": " + std::to_string(uint32_t(figures_.samples)) + " samples per pixel";
    if (figures_.error) {
        char text[48];
        std::snprintf(text, sizeof text, ", estimated error %.2f %%", 100.0 * *figures_.error);
        title += text;
    }
    window_.set_title(title + (scale_ > 1 ? ", moving" : state_.paused ? ", paused" : ""));
}

void Viewer::tell(const std::string& message) {
    figures_.message = message;
    options_.say(message);
}

}  // namespace candela
