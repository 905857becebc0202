// What the user of the viewer can change, and what the viewer tells.
#pragma once

#include <optional>
#include <string>

#include "base/tonemap.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace candela {

struct ViewState {
    Camera camera;
    RenderSettings settings;  // Of the picture at rest.
    float exposure_ev = 0.0f;
    Tonemap tonemap = Tonemap::linear;
    float environment_rotation = 0.0f;   // [rad]
    float environment_intensity = 1.0f;  // Times what the scene says.
    float intensity_slider = 1.0f;       // The same while the slider is dragged.
    bool paused = false;
    bool panel = true;  // Is shown.
};

// What the user asks for once.
struct ViewRequests {
    bool restart = false;
    bool home = false;      // The camera as the scene has it.
    bool save_png = false;  // The picture as it is shown, without the panel.
    bool save_exr = false;  // Radiance and more.
    bool save_camera = false;
    bool close = false;
    std::optional<size_t> camera;  // The scene's camera to take.
    std::optional<vec2>
        focus;  // What lies there shall be sharp; in the window, (0,0) .. (1,1) from the top left.
};

// What the panel tells.
struct ViewFigures {
    std::string device;
    uint64_t device_bytes = 0;
    uvec2 size{0, 0};      // Of the picture right now; smaller than the window while the camera moves.
    double samples = 0.0;  // Per pixel, in the mean.
    double samples_per_second = 0.0;  // Of all pixels together.
    std::optional<double> error;      // Relative, as estimated last; see estimate_relative_error().
    std::string message;              // What happened last.
};

}  // namespace candela
