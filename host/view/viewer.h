// Viewer: shows in a window how a picture accumulates, and lets the user move the camera and change the
// settings.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/gpu_scene.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "view/display.h"
#include "view/gui.h"
#include "view/view_state.h"
#include "view/window.h"
#include "vk/presenter.h"

namespace candela {

struct ViewerOptions {
    std::string name;               // Of the scene, for the title and for files.
    uint32_t target = 0;            // Samples per pixel to stop at, above 0.
    bool close_at_target = false;   // End there, and keep the picture's size whatever the window's.
    std::function<bool()> stopped;  // Asked now and then: end now?
    std::function<void(const std::string&)> say;  // Told what happened: "wrote box-1.png".
};

class Viewer {
  public:
    // `window` and `device` must outlive the viewer; `presenter` shows in that window.
    Viewer(Window& window, const vk::Device& device, vk::Presenter presenter, Scene scene, ViewState state,
           ViewerOptions options);

    // Runs until the window is closed, options.stopped() says so or, if asked for, the target is reached.
    // Returns whether the picture is at rest and has all samples.
    bool run();

    // Writes the picture as it is: .png as it is shown, without the panel, or .exr with its radiance and
    // more. Throws Error if that fails.
    void save(const std::filesystem::path& path);

  private:
    using Clock = std::chrono::steady_clock;

    bool ended() const;
    bool changed_lately() const;
    void begin();
    void measure(double progress);
    bool step(double progress);
    void frame();
    void apply(const ViewRequests& requests);
    void set_focus(vec2 place);
    void note_changes(const ViewState& before);
    void update_figures();
    void save_as_next(const std::string& extension, const std::function<void(const std::string&)>& write);
    void tell(const std::string& message);

    Window& window_;
    const vk::Device& device_;
    vk::Presenter presenter_;
    Scene scene_;
    std::vector<vec3> radiance_;  // Of the scene's environment, at intensity 1.
    GpuScene gpu_scene_;
    ViewState state_;
    ViewerOptions options_;
    Camera home_;

    Gui gui_;
    Display display_;
    std::unique_ptr<Renderer> renderer_;
    ViewFigures figures_;

    uint32_t scale_ = 1;    // The picture's sides are divided by this: by 1 unless it was begun while ...
    bool moving_ = false;   // ... the camera moved; then what comes next depends ...
    bool is_first_ = true;  // ... on when it has its first samples, of which none was seen yet.
    uint32_t next_scale_;
    bool restart_ = false;  // The picture no longer shows what it shall.
    bool rebuild_ = false;  // Nor does the scene on the device.
    Clock::time_point begun_;
    Clock::time_point last_change_;
    Clock::time_point last_activity_;
    Clock::time_point last_frame_;
    Clock::time_point next_draw_;
    Clock::time_point next_error_;
    // For the rate: since when the device has worked without a break, and what had been done then.
    Clock::time_point measured_from_;
    double measured_samples_ = 0.0;
};

}  // namespace candela
