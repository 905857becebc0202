// Scenes as commands load them: with progress and warnings on stderr.
#pragma once

#include <string>

#include "cli/loading_options.h"
#include "cli/message_options.h"
#include "gpu_scene/gpu_scene.h"
#include "scene/scene.h"

namespace candela {

// load_scene(). Prints how far it has got, and the scene's warnings. A signal ends the program.
Scene load_with_progress(const std::string& file, const LoadingOptions& options,
                         ProgressStyle style = ProgressStyle::automatic);

// build_gpu_scene_freeing_images(), in the same way.
GpuScene build_with_progress(Scene& scene, ProgressStyle style = ProgressStyle::automatic);

// Prints a warning if the scene has lights that the estimator cannot find.
void warn_of_unseen_lights(const Scene& scene, Estimator estimator);

}  // namespace candela
