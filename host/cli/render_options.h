// The options of `candela render`, by subject.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/camera_options.h"
#include "cli/frame_options.h"
#include "cli/image_options.h"
#include "cli/message_options.h"
#include "cli/rendering_options.h"
#include "film/sample_range.h"
#include "scene/scene.h"
#include "session/job.h"

namespace candela {

// When a rendering ends, and which samples it has until then.
struct StoppingOptions {
    std::optional<double> target_error;  // Relative error of the image.
    std::optional<double> time_limit;    // Seconds.
    bool adaptive = false;               // Samples go where the error is.
    std::optional<SampleRange> samples;  // Only these, instead of SamplingOptions::spp.

    // Declares them on `app`, after SamplingOptions; this object must not move.
    void add_to(CLI::App& app);
};

// What a rendering writes, besides checkpoints.
struct OutputOptions {
    ImageOutputs images;
    std::optional<std::string> report;     // "-": stdout.
    std::optional<double> write_every;     // Seconds.
    std::optional<std::string> reference;  // An image to measure the error against.

    // Declares them on `app`; this object must not move.
    void add_to(CLI::App& app);
};

// Which pictures are rendered.
struct ListOptions {
    std::vector<std::string> scenes;   // As list_scenes() reads them.
    std::vector<std::string> cameras;  // By name; none: each scene's first,
    bool all_cameras = false;          // unless this asks for all.
    bool skip_existing = false;        // Not those whose files are there.
    bool stop_on_error = false;        // None after the first that fails.
    std::optional<double> batch_time;  // None that is not whole after so many seconds.

    // Each declares a part of them on `app`; this object must not move.
    void add_scenes_to(CLI::App& app);
    void add_cameras_to(CLI::App& app);
};

struct RenderOptions {
    ListOptions list;
    CameraOptions cameras;
    RenderingOptions rendering;
    FrameOptions frames;
    StoppingOptions stopping;
    OutputOptions outputs;
    CheckpointOptions checkpoint;
    MessageOptions messages;

    // Declares all options on `app`, which fills them in when it parses; this object must not move.
    void add_to(CLI::App& app);

    // Whether each camera of a scene, or each view around it, has a picture.
    bool wants_all_cameras() const {
        return list.all_cameras || (list.cameras.empty() && cameras.view_count() > 1);
    }
    // Combines them with what the scene proposes, for its camera of that name, or its first. Throws Error
    // (usage) for a camera that the scene lacks or that cannot be shifted, a crop that reaches beyond the
    // picture, or --adaptive with an odd number of samples.
    RenderJob job(const Scene& loaded, const std::optional<std::string>& camera = {}) const;
};

}  // namespace candela
