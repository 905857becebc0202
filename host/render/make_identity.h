// The identity of a rendering.
#pragma once

#include "film/identity.h"
#include "gpu_scene/gpu_scene.h"
#include "render/renderer.h"

namespace candela {

// The identity does not depend on the number of samples, the first sample, the AOVs or how the kernels read
// the scene.
Identity make_identity(const GpuScene& scene, const Camera& camera, const RenderSettings& settings);

}  // namespace candela
