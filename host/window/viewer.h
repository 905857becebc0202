// Viewer: shows a picture in a window as it accumulates, and lets the user move the camera and change the
// settings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "gpu_scene/scene_stages.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "session/recovery.h"
#include "view/clock.h"
#include "view/display.h"
#include "view/picture_copy.h"
#include "view/view_denoiser.h"
#include "vk/device.h"
#include "vk/instance.h"
#include "vk/presenter.h"
#include "window/controls.h"
#include "window/gui.h"
#include "window/view_state.h"
#include "window/window.h"

namespace candela {

struct ViewerOptions {
    vk::DeviceInfo device;  // After choose_presenting_queue().
    std::optional<std::filesystem::path> pipeline_cache_folder;
    std::string name;               // Name of the scene, for the title and for files.
    std::string command_line;       // For the attributes of EXRs.
    uint32_t target = 0;            // Samples per pixel to stop at, above 0.
    bool close_at_target = false;   // Close then, and keep the picture's size regardless of the window's.
    bool start_page = false;        // The panel says how to open a scene.
    std::function<bool()> stopped;  // Called regularly; returns whether to end.
    std::function<void(const std::string&)> say;  // Gets events, such as "wrote box-1.png".
    std::shared_ptr<Denoiser> denoiser;           // Not null.
};

class Viewer {
  public:
    // Opens the device and prepares everything; `window`, which has no surface yet, and `instance` must
    // outlive the viewer. Throws Error if that fails.
    Viewer(Window& window, const vk::Instance& instance, Scene scene, ViewState state, ViewerOptions options);

    // Runs until the window is closed, a file is dropped onto it, options.stopped() returns true or, with
    // close_at_target, the target is reached; another call continues. Returns whether the picture is at rest
    // and has all samples. If the device is lost or out of memory, reopens it, and a picture at rest
    // continues from its copy on the host, to the same bits. If Recovery gives up, writes the copy to a file
    // and throws the Error.
    bool run();

    // Writes the current picture: as .png as it is shown, without the panel, or as .exr as by `candela
    // render`. Throws Error if that fails.
    void save(const std::filesystem::path& path);

    // Says it, and shows it in the panel.
    void tell(const std::string& message);

    // The scene and how it is seen, for another viewer; this one is then unusable.
    std::pair<Scene, ViewState> leave() &&;

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
    const vk::StorageImage& shown();
    void denoise();
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

    Window& window_;
    const vk::Instance& instance_;
    Scene scene_;
    std::vector<vec3> radiance_;  // The scene's environment, at intensity 1.
    float intensity_ = 1.0f;      // The environment's factor in scene_.
    SceneStages stages_;
    const GpuScene& gpu_scene_ = stages_.joined();
    ViewState state_;
    ViewerOptions options_;

    Gui gui_;
    Controls controls_;
    ViewFigures figures_;

    // All null between the loss of a device and the opening of the next.
    std::unique_ptr<vk::Device> device_;
    std::unique_ptr<vk::Presenter> presenter_;
    std::unique_ptr<Display> display_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<vk::StorageImage>
        denoised_;  // Like an accumulation of one sample; null without a result.
    Recovery recovery_;

    // The picture in progress: its camera and settings, the samples that every pixel has, the number of
    // samples at the next look, and the time so far [s].
    Camera camera_;
    RenderSettings settings_;
    uint32_t spp_ = 0;
    uint32_t stop_ = 0;
    double render_seconds_ = 0.0;
    PictureCopy copy_;
    ViewDenoiser denoiser_;
    double denoised_samples_ = 0.0;  // Of the picture when the last run began.

    uint32_t scale_ = 1;    // The picture's sides are divided by this; 1 if it was begun at rest.
    bool moving_ = false;   // Whether it was begun while the camera moved.
    bool is_first_ = true;  // Whether its first samples have not been shown yet; their time determines the
                            // next scale.
    uint32_t next_scale_;
    bool restart_ = true;  // The picture is outdated.
    Clock::time_point begun_;
    Clock::time_point last_change_;
    Clock::time_point last_frame_;
    double frame_seconds_ = 0.0;  // Time from the last frame to this one, up to a limit.
    Clock::time_point next_draw_;
    // For the rate: the time since which the device has worked without a break, and the samples at that time.
    Clock::time_point measured_from_;
    double measured_samples_ = 0.0;
};

}  // namespace candela
