// What is computed and where, for the commands that render.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/arguments.h"
#include "cli/loading_options.h"
#include "render/renderer.h"
#include "scene/names.h"
#include "scene/scene.h"

namespace candela {

inline constexpr Choices<SceneAccess, 3> SCENE_ACCESS_NAMES{{{"auto", SceneAccess::automatic},
                                                             {"texel", SceneAccess::texel_buffers},
                                                             {"storage", SceneAccess::storage_buffers}}};

// The headline of what --help says of sampling.
inline constexpr const char* SAMPLING_GROUP = "Sampling (defaults: the scene's)";

// Each of the following declares its options on `app`, which fills them in when it parses; the objects must
// not move. An empty optional leaves the choice to the scene file.

struct SceneOptions {
    std::string file;
    std::optional<std::string> camera;

    CLI::Option* add_file_to(CLI::App& app);
    void add_camera_to(CLI::App& app);
    // The camera of that name, by default the scene's first. Throws Error (usage) that lists the names if
    // there is none.
    const Camera& choose_camera(const Scene& scene) const;
};

struct SamplingOptions {
    std::optional<uint32_t> spp;
    std::optional<uint32_t> seed;
    std::optional<uint32_t> max_depth;  // DEPTH_SAFETY_LIMIT: unlimited.
    std::optional<uint32_t> rr_depth;
    std::optional<Estimator> estimator;
    std::optional<SamplerKind> sampler;
    std::optional<LightSampler> light_sampler;
    std::optional<Terminator> terminator;
    std::optional<PixelFilter> filter;
    std::optional<float> clamp_indirect;

    void add_to(CLI::App& app);
};

struct DeviceOptions {
    std::optional<std::string> name;  // Index or part of the name.
    SceneAccess scene_access = SceneAccess::automatic;

    void add_to(CLI::App& app);
};

struct RenderingOptions {
    PictureOptions picture;
    LoadingOptions loading;
    SamplingOptions sampling;
    DeviceOptions device;

    void add_to(CLI::App& app);
    // Joins them with what the scene proposes for a picture by one of its cameras. Throws Error (usage) if
    // the crop exceeds the picture.
    RenderSettings settings(const Scene& scene, const Camera& camera) const;
};

}  // namespace candela
