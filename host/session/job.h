// What a rendering is asked to do.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "film/accumulation.h"
#include "image/labels.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace candela {

struct CheckpointOptions {
    std::optional<std::string> file{};
    double every = 60.0;  // Seconds.
    bool resume = false;  // From the file, if it exists.
};

// The scene's camera of that name, or its first. Throws Error (usage) that begins with `place` and lists the
// names if there is none.
const Camera& choose_camera(const Scene& scene, const std::optional<std::string>& name,
                            const std::string& place);

// What the scene proposes for a picture by one of its cameras.
RenderSettings proposed_settings(const Scene& scene, const Camera& camera);

// RenderSettings::layer_bytes for these images: what rays find first, and the layers that it is made into.
uint32_t layer_bytes(const AovSelection& aovs);

// What a rendering needs in addition to the scene.
struct RenderJob {
    Camera camera;
    RenderSettings settings;
    uint32_t target = 0;                     // Samples per pixel, unless an error or a time ends it earlier.
    bool adaptive = false;                   // Samples go where the error is.
    std::optional<double> target_error{};    // Relative error of the image.
    std::optional<double> time_limit{};      // Seconds.
    std::optional<double> write_every{};     // Seconds from one image on the way to the next.
    AovSelection aovs{};                     // The images besides R G B A.
    std::shared_ptr<const Labels> labels{};  // Of the scene, for images of ids.
    std::optional<MotionSince> motion{};     // For the image of motion.
    CheckpointOptions checkpoint{};
};

}  // namespace candela
