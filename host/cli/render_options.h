// The options of `candela render`, by subject.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/camera_options.h"
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

struct RenderOptions {
    SceneOptions scene;
    CameraOptions cameras;
    RenderingOptions rendering;
    StoppingOptions stopping;
    OutputOptions outputs;
    CheckpointOptions checkpoint;
    MessageOptions messages;

    // Declares all options on `app`, which fills them in when it parses; this object must not move.
    void add_to(CLI::App& app);

    // Combines them with what the scene proposes. Throws Error (usage) for a camera that the scene lacks, a
    // crop that reaches beyond the picture, or --adaptive with an odd number of samples.
    RenderJob job(const Scene& loaded) const;
};

}  // namespace candela
