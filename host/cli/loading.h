// Scenes as commands load them: with progress and warnings on stderr.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/loading_options.h"
#include "cli/message_options.h"
#include "gpu_scene/gpu_scene.h"
#include "load/load.h"
#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

// What the options ask of load_scene(), within the limit on memory that they state from now on.
LoadOptions load_options(const LoadingOptions& options, const LoadProgress& progress = no_progress);

// load_scene() and build_gpu_scene_freeing_images() within the limit on memory. They print nothing, so that
// another thread may call them.
Scene load_quietly(const std::string& file, const LoadingOptions& options,
                   const LoadProgress& progress = no_progress);
GpuScene build_quietly(Scene& scene);

// load_quietly(). Prints how far it has got. A signal ends the program.
Scene load_showing_progress(const std::string& file, const LoadingOptions& options, ProgressStyle style);
// Calls load() with the progress that it has to report, in the same way.
void show_progress(ProgressStyle style, const std::function<void(const LoadProgress&)>& load);
// load_showing_progress(); also prints the scene's warnings.
Scene load_with_progress(const std::string& file, const LoadingOptions& options,
                         ProgressStyle style = ProgressStyle::automatic);

// build_quietly(), in the same two ways.
GpuScene build_showing_progress(Scene& scene, ProgressStyle style);
GpuScene build_with_progress(Scene& scene, ProgressStyle style = ProgressStyle::automatic);

// A warning, or none, if much of the picture sees single-sided surfaces from behind.
std::vector<std::string> warnings_of_unseen_backs(const Scene& scene, const Camera& camera, uvec2 size);

// A warning, or none, if the scene has lights that the estimator cannot find.
std::vector<std::string> warnings_of_unseen_lights(const Scene& scene, Estimator estimator);

}  // namespace candela
