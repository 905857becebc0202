// The options of `candela render`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/tonemap.h"
#include "cli/arguments.h"
#include "film/accumulation.h"
#include "film/sample_range.h"
#include "render/renderer.h"
#include "scene/names.h"
#include "scene/scene.h"

namespace candela {

inline constexpr Choices<SceneAccess, 3> SCENE_ACCESS_NAMES{{{"auto", SceneAccess::automatic},
                                                             {"texel", SceneAccess::texel_buffers},
                                                             {"storage", SceneAccess::storage_buffers}}};
inline constexpr Choices<Tonemap, 5> TONEMAP_NAMES{{{"linear", Tonemap::linear},
                                                    {"reinhard", Tonemap::reinhard},
                                                    {"aces", Tonemap::aces},
                                                    {"agx", Tonemap::agx},
                                                    {"neutral", Tonemap::neutral}}};

enum class ProgressStyle { automatic, json, none };
inline constexpr Choices<ProgressStyle, 3> PROGRESS_NAMES{
    {{"auto", ProgressStyle::automatic}, {"json", ProgressStyle::json}, {"none", ProgressStyle::none}}};

// What stands on the command line; an empty optional leaves the choice to the scene file.
struct RenderOptions {
    std::string scene_file;
    std::vector<std::string> outputs;
    std::optional<std::string> report;  // "-": stdout.
    AovSelection aovs{true, true, true, true, true, true};
    bool half = false;
    std::optional<double> write_every;     // Seconds.
    std::optional<std::string> reference;  // An image to measure the error against.
    double exposure = 0.0;                 // EV.
    Tonemap tonemap = Tonemap::linear;

    PictureOptions picture;
    std::optional<std::string> camera;

    std::optional<uint32_t> spp;
    std::optional<double> target_error;  // Relative error of the image.
    std::optional<double> time_limit;    // Seconds.
    bool adaptive = false;               // Samples go where the error is.
    std::optional<SampleRange> samples;  // Instead of spp: these alone.
    std::optional<uint32_t> seed;
    std::optional<uint32_t> max_depth;  // DEPTH_SAFETY_LIMIT: unlimited.
    std::optional<uint32_t> rr_depth;
    std::optional<Estimator> estimator;
    std::optional<SamplerKind> sampler;

    std::optional<std::string> checkpoint;
    double checkpoint_every = 60.0;  // Seconds.
    bool resume = false;

    std::optional<std::string> device;  // Index or part of the name.
    SceneAccess scene_access = SceneAccess::automatic;
    ProgressStyle progress = ProgressStyle::automatic;
    bool quiet = false;
    bool verbose = false;

    // Declares them all on `app`, which fills them in when it parses; this object must stay where it is.
    void add_to(CLI::App& app);
    // Declares those alone that say what is computed and where: picture, sampling, device.
    void add_rendering_to(CLI::App& app);
    // Declares those alone that say which images are written, and how: outputs, 16 bits, development.
    void add_images_to(CLI::App& app);
    // Declares those alone that say how radiance becomes a picture: exposure and tone map.
    void add_development_to(CLI::App& app);
    // Declares --camera.
    void add_camera_to(CLI::App& app);

    // The images beside R G B A that will be written: those selected if there is an EXR among the outputs,
    // else none.
    AovSelection written_aovs() const;
    // The camera of that name, by default the scene's first. Throws Error (usage) that lists the names if
    // there is none.
    const Camera& choose_camera(const Scene& scene) const;
    // Samples per pixel to reach, if no target error and no time limit ends it before.
    uint32_t target_spp(const Scene& scene) const {
        return samples ? samples->count() : spp.value_or(scene.integrator.spp);
    }
    // The renderer's settings for a scene. Throws Error (usage) if the crop reaches beyond the picture.
    RenderSettings settings(const Scene& scene) const;

  private:
    void add_output_options(CLI::App& app);
    void add_sampling_options(CLI::App& app);
    void add_checkpoint_options(CLI::App& app);
    void add_message_options(CLI::App& app);
};

}  // namespace candela
