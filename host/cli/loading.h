// Scenes as commands load them: with progress and warnings on stderr.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/render_options.h"
#include "scene/scene.h"

namespace candela {

// Adds --texture-limit.
void add_texture_limit(CLI::App& app, std::optional<uint32_t>& limit);

// load_scene(), with images of at most `texture_limit` texels along a side. Prints how many images are
// decoded, and the scene's warnings.
Scene load_with_progress(const std::string& file, std::optional<uint32_t> texture_limit,
                         ProgressStyle style = ProgressStyle::automatic);

// Prints a warning if the scene has lights that the estimator cannot find.
void warn_of_unseen_lights(const Scene& scene, Estimator estimator);

}  // namespace candela
