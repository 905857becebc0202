// The options of every group of benchmarks.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace candela {

struct BenchOptions {
    uint32_t runs = 5;                                 // For each figure, after a warm-up; at least 1.
    std::vector<uint32_t> triangles{190000, 1000000};  // Approximate sizes of the meshes; see meshes.h.
    uint32_t trees = 10'000;                           // Trees of the forest; see meshes.h.
    uint32_t instances = 1'000'000;                    // Instances of the small mesh; see meshes.h.
    uint32_t rays = 1u << 20;                          // Approximate number of camera rays.
    SceneAccess scene_access = SceneAccess::automatic;
    std::function<void(const std::string&)> progress;  // Gets the next task: "traversal: 1 M triangles".
};

}  // namespace candela
