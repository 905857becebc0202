// Classes of kernels, so that models share them.
#pragma once

#include "gpu_scene/gpu_scene.h"
#include "render/renderer.h"
#include "shared/kernel_constants.h"

namespace candela {

// Allows for more than the scene has, so that scenes share kernels: lavapipe takes half a second and more to
// compile one. Small models share those of a few classes; others only widen what costs no time
// (tests/bench/NOTEBOOK.md, "Kernel"). The picture stays the same, bit by bit; but in the class of what is
// rare, and where a lamp is the only light, it has other noise.
void widen(KernelConstants& constants, const GpuScene& scene, const RenderSettings& settings);

}  // namespace candela
