// The settings that the viewer's user can change, and the figures that it shows.
#pragma once

#include <optional>
#include <string>

#include "image/tonemap.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace candela {

struct ViewState {
    Camera camera;
    Camera home;              // The scene's, to which ViewRequests::home goes back.
    RenderSettings settings;  // Settings of the picture at rest.
    float exposure_ev = 0.0f;
    Tonemap tonemap = Tonemap::linear;
    float environment_rotation = 0.0f;   // [rad]
    float environment_intensity = 1.0f;  // Relative to the scene's.
    float intensity_slider = 1.0f;       // The same, while the slider is dragged.
    bool paused = false;
    bool denoise = false;  // Whether the picture at rest is shown denoised.
    bool panel = true;     // Whether it is shown.
};

// The user's one-time requests.
struct ViewRequests {
    bool restart = false;
    bool home = false;      // Back to ViewState::home.
    bool save_png = false;  // The picture as it is shown, without the panel.
    bool save_exr = false;  // Radiance and more.
    bool save_camera = false;
    bool close = false;
    std::optional<size_t> camera;  // Switch to this camera of the scene.
    std::optional<vec2>
        focus;  // Focus on the point seen there; in the window, (0,0) .. (1,1) from the top left.
};

// The figures on the panel.
struct ViewFigures {
    std::string device;
    uint64_t device_bytes = 0;
    uvec2 size{0, 0};      // Size of the current picture; smaller than the window while the camera moves.
    double samples = 0.0;  // Per pixel, on average.
    double samples_per_second = 0.0;  // Sum over all pixels.
    std::optional<double> error;      // Relative, the last estimate; see estimate_relative_error().
    std::string message;              // The last event.
};

}  // namespace candela
