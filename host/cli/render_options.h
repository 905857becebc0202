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
#include "render/accumulation.h"
#include "render/renderer.h"
#include "scene/names.h"
#include "scene/scene.h"

namespace candela {

// Samples per pixel at most: their counts are kept as 32-bit floats, which are exact up to here.
inline constexpr uint32_t MAX_SPP = 1u << 24;

inline constexpr Choices<SceneAccess, 3> SCENE_ACCESS_NAMES{{{"auto", SceneAccess::automatic},
                                                             {"texel", SceneAccess::texel_buffers},
                                                             {"storage", SceneAccess::storage_buffers}}};
inline constexpr Choices<Tonemap, 5> TONEMAP_NAMES{{{"linear", Tonemap::linear},
                                                    {"reinhard", Tonemap::reinhard},
                                                    {"aces", Tonemap::aces},
                                                    {"agx", Tonemap::agx},
                                                    {"neutral", Tonemap::neutral}}};

// What stands on the command line; an empty optional leaves the choice to the scene file.
struct RenderOptions {
    std::string scene_file;
    std::vector<std::string> outputs;
    std::optional<std::string> report;  // "-": stdout.
    AovSelection aovs{true, true, true, true, true, true};
    bool half = false;
    double exposure = 0.0;  // EV.
    Tonemap tonemap = Tonemap::linear;

    PictureOptions picture;
    std::optional<std::string> camera;

    std::optional<uint32_t> spp;
    std::optional<double> time_limit;  // Seconds.
    std::optional<uint32_t> seed;
    std::optional<uint32_t> max_depth;  // DEPTH_SAFETY_LIMIT: unlimited.
    std::optional<uint32_t> rr_depth;
    std::optional<Estimator> estimator;
    std::optional<SamplerKind> sampler;

    std::optional<std::string> device;  // Index or part of the name.
    SceneAccess scene_access = SceneAccess::automatic;
    bool quiet = false;
    bool verbose = false;

    // Declares them all on `app`, which fills them in when it parses; this object must stay where it is.
    void add_to(CLI::App& app);
    // Declares those alone that say what is computed and where: picture, sampling, device.
    void add_rendering_to(CLI::App& app);

    // The images beside R G B A that will be written: those selected if there is an EXR among the outputs,
    // else none.
    AovSelection written_aovs() const;
    // Samples per pixel to reach.
    uint32_t target_spp(const Scene& scene) const { return spp.value_or(scene.integrator.spp); }
    // The renderer's settings for a scene. Throws Error (usage) if the crop reaches beyond the picture.
    RenderSettings settings(const Scene& scene) const;

  private:
    void add_output_options(CLI::App& app);
    void add_sampling_options(CLI::App& app);
    void add_message_options(CLI::App& app);
};

}  // namespace candela
