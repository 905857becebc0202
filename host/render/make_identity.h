// The identity of a rendering.
#pragma once

#include "film/identity.h"
#include "gpu_scene/gpu_scene.h"
#include "render/renderer.h"

namespace candela {

// The identity does not depend on the number of samples, the first sample, the AOVs or how the kernels read
// the scene.
Identity make_identity(const GpuScene& scene, const Camera& camera, const RenderSettings& settings);

// The same for pictures that share a scene: the hash of its arrays, and the identity of each picture with it.
uint64_t hash_arrays(const GpuScene& scene);
Identity make_identity(const GpuScene& scene, uint64_t arrays_hash, const Camera& camera,
                       const RenderSettings& settings);

}  // namespace candela
