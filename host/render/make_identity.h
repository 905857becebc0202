// The identity of what a renderer is asked for.
#pragma once

#include "film/identity.h"
#include "gpu_scene/gpu_scene.h"
#include "render/renderer.h"

namespace candela {

// Not of the number of samples, the first sample, the AOVs or how the kernels read the scene.
Identity make_identity(const GpuScene& scene, const Camera& camera, const RenderSettings& settings);

}  // namespace candela
