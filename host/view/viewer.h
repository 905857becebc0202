// Viewer: shows in a window how a picture accumulates, and lets the user move the camera and change the
// settings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/image.h"
#include "gpu_scene/gpu_scene.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "view/clock.h"
#include "view/controls.h"
#include "view/display.h"
#include "view/gui.h"
#include "view/picture_copy.h"
#include "view/view_state.h"
#include "view/window.h"
#include "vk/device.h"
#include "vk/instance.h"
#include "vk/presenter.h"

namespace candela {

// A picture that was rendered in a window.
struct ViewedPicture {
    const GpuScene& scene;
    const Camera& camera;
    const RenderSettings& settings;
    const Accumulation& state;
    double seconds;  // Wall time of rendering it.
};

struct ViewerOptions {
    vk::DeviceInfo device;  // After choose_presenting_queue().
    std::optional<std::filesystem::path> pipeline_cache_folder;
    std::string name;               // Of the scene, for the title and for files.
    uint32_t target = 0;            // Samples per pixel to stop at, above 0.
    bool close_at_target = false;   // End there, and keep the picture's size whatever the window's.
    std::function<bool()> stopped;  // Asked now and then: end now?
    std::function<void(const std::string&)> say;  // Told what happened: "wrote box-1.png".
    // Gives the image of an EXR its attributes.
    std::function<void(Image&, const ViewedPicture&)> add_attributes;
};

class Viewer {
  public:
    // Opens the device and prepares everything; `window`, which has no surface yet, and `instance` must
    // outlive the viewer. Throws Error if that fails.
    Viewer(Window& window, const vk::Instance& instance, Scene scene, ViewState state, ViewerOptions options);

    // Runs until the window is closed, options.stopped() says so or, if asked for, the target is reached.
    // Returns whether the picture is at rest and has all samples. If the device is lost or out of memory, it
    // is opened anew, and a picture at rest goes on from its copy on the host to the same bits. Throws the
    // Error if that happens SteadyRenderer::MOST_FAILURES times without progress of the copy, and writes that
    // to a file before.
    bool run();

    // Writes the picture as it is: .png as it is shown, without the panel, or .exr as `candela render` would
    // write it. Throws Error if that fails.
    void save(const std::filesystem::path& path);

  private:
    bool ended() const;
    bool changed_lately() const;
    void open();
    void recover(const Error& error);
    void begin();
    bool accumulate();
    void measure(double progress);
    bool step(double progress);
    void frame();
    void turn(const Input* input);
    void apply(const ViewRequests& requests);
    void set_focus(vec2 place);
    bool outdated() const;
    void note_changes();
    void update_title();
    void write_radiance(const std::filesystem::path& path, const Accumulation& state,
                        const std::vector<float>& positions);
    void save_copy();
    void save_as_asked(const ViewRequests& requests);
    void save_as_next(const std::string& extension, const std::function<void(const std::string&)>& write);
    void tell(const std::string& message);

    Window& window_;
    const vk::Instance& instance_;
    Scene scene_;
    std::vector<vec3> radiance_;  // Of the scene's environment, at intensity 1 ...
    float intensity_ = 1.0f;      // ... and what scene_ has it multiplied by.
    GpuScene gpu_scene_;
    ViewState state_;
    ViewerOptions options_;
    Camera home_;

    Gui gui_;
    Controls controls_;
    ViewFigures figures_;

    // All null between the loss of a device and the opening of the next.
    std::unique_ptr<vk::Device> device_;
    std::unique_ptr<vk::Presenter> presenter_;
    std::unique_ptr<Display> display_;
    std::unique_ptr<Renderer> renderer_;
    std::optional<Error> cause_;       // Of the last failure that was not one of opening.
    uint32_t failures_ = 0;            // In a row, since the copy of the picture went on.
    uint64_t samples_at_failure_ = 0;  // Of the copy, at the last failure.

    // The picture in the making: what it was begun with, the samples that every pixel holds at least, at how
    // many it is looked at next, and how long it took so far [s].
    Camera camera_;
    RenderSettings settings_;
    uint32_t spp_ = 0;
    uint32_t stop_ = 0;
    double render_seconds_ = 0.0;
    PictureCopy copy_;

    uint32_t scale_ = 1;    // The picture's sides are divided by this: by 1 unless it was begun while ...
    bool moving_ = false;   // ... the camera moved; then what comes next depends ...
    bool is_first_ = true;  // ... on when it has its first samples, of which none was seen yet.
    uint32_t next_scale_;
    bool restart_ = true;  // The picture no longer shows what it shall.
    Clock::time_point begun_;
    Clock::time_point last_change_;
    Clock::time_point last_frame_;
    double frame_seconds_ = 0.0;  // From the last frame to this one, if it was not long.
    Clock::time_point next_draw_;
    // For the rate: since when the device has worked without a break, and what had been done then.
    Clock::time_point measured_from_;
    double measured_samples_ = 0.0;
};

}  // namespace candela
