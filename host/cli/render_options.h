// The options of `candela render`, by subject.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

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

enum class ProgressStyle { automatic, json, none };
inline constexpr Choices<ProgressStyle, 3> PROGRESS_NAMES{
    {{"auto", ProgressStyle::automatic}, {"json", ProgressStyle::json}, {"none", ProgressStyle::none}}};

// The images that are written, and their formats.
struct ImageOutputs {
    std::vector<std::string> files;
    AovSelection aovs{true, true, true, true, true, true};  // In an EXR.
    bool half = false;                                      // EXR: R G B A and Albedo with 16 bits.
    double exposure = 0.0;                                  // PNG [EV].
    Tonemap tonemap = Tonemap::linear;                      // PNG.

    // The images besides R G B A that will be written: those selected, if one of the files is an EXR;
    // otherwise none.
    AovSelection written_aovs() const;
};

struct MessageOptions {
    ProgressStyle progress = ProgressStyle::automatic;
    bool quiet = false;
    bool verbose = false;
};

// What the argument SCENE of a command may name.
inline constexpr const char* SCENE_FILES = "Scene file (.json, .gltf, .glb, .obj, .ply)";

// How scene files are read.
struct LoadingOptions {
    std::optional<uint32_t> texture_limit;  // Texels along a side of an image.
    IfMissing missing_images = IfMissing::white;
    std::vector<std::string> folders;      // Files may be read from these, too.
    bool any_folder = false;               // Whether they may be read from anywhere.
    std::optional<uint64_t> memory_limit;  // Bytes; none: default_memory_limit().
    GltfOptions gltf;

    // Declares them on `app`; this object must not move.
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
    RenderingOptions rendering;
    StoppingOptions stopping;
    OutputOptions outputs;
    CheckpointOptions checkpoint;
    MessageOptions messages;

    // Declares all options on `app`, which fills them in when it parses; this object must not move.
    void add_to(CLI::App& app);
    // Declares only the options of what is computed and where: picture, sampling, device.
    void add_rendering_to(CLI::App& app);
    // Declares only the options of images and how they are written: outputs, 16 bits, development.
    void add_images_to(CLI::App& app);
    // Declares only the options that turn radiance into a picture: exposure and tone map.
    void add_development_to(CLI::App& app);
    // Declares --camera.
    void add_camera_to(CLI::App& app);

    // Combines them with what the scene proposes. Throws Error (usage) for a camera that the scene lacks, a
    // crop that reaches beyond the picture, or --adaptive with an odd number of samples.
    RenderJob job(const Scene& scene) const;
    // The camera of that name, by default the scene's first. Throws Error (usage) that lists the names if
    // there is none.
    const Camera& choose_camera(const Scene& scene) const;
    // The renderer's settings for a scene. Throws Error (usage) if the crop exceeds the picture.
    RenderSettings settings(const Scene& scene) const;

  private:
    void add_output_options(CLI::App& app);
    void add_sampling_options(CLI::App& app);
    void add_checkpoint_options(CLI::App& app);
    void add_message_options(CLI::App& app);
};

}  // namespace candela
