// The benchmark of whole renders: samples per second, rays per sample, and the error after a given time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/options.h"
#include "bench/report.h"
#include "image/image.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "vk/device.h"

namespace candela {

struct RenderTask {
    std::string name;
    Scene scene;
    RenderSettings settings{};             // Without AOVs.
    uint32_t spp = 0;                      // Samples per pixel of a run.
    std::optional<double> seconds{};       // If given, the run ends after this time [s] at the latest.
    std::optional<RgbPlanes> reference{};  // A converged image of the same crop, if the error is wanted.
};

// Speed [Msamples/s], rays per sample, and, if there is a reference, relMSE at the end of a run. Each run has
// its own seed. Times are of rendering alone. On a CPU device they are CPU time over the number of cores,
// with speeds by wall time beside them; on a GPU they are wall time. A run ends at most a few per cent late.
// Throws Error as Renderer does.
std::vector<Row> bench_render(const vk::Device& device, const BenchOptions& options, const RenderTask& task);

}  // namespace candela
