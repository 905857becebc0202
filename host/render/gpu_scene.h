// Scene -> records: the arrays that the device reads, made without any device.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/light.h"
#include "shared/types.h"

namespace candela {

struct GpuScene {
    // Records as shared/*.h describe them, in words of uvec4.
    std::vector<uvec4> nodes;       // BVH nodes, the root first.
    std::vector<uvec4> primitives;  // In leaf order.
    std::vector<uvec4>
        tables;             // Normals (in leaf order; none if all are flat), materials, lights, alias table.
    uvec4 table_starts{0};  // First words of those four in `tables`.

    uint32_t primitive_count = 0;
    uint32_t light_count = 0;
    bool has_normals = false;

    // About the BVH, for reports.
    uint32_t bvh_depth = 0;
    float bvh_sah_cost = 0.0f;
    double bvh_seconds = 0.0;  // Wall time of the build alone.

    // Bytes that the arrays take on a device.
    uint64_t bytes() const { return (nodes.size() + primitives.size() + tables.size()) * sizeof(uvec4); }
};

// Flattens the shapes into primitives, builds the BVH and packs everything. Throws Error if the scene has
// more primitives than a BVH can address.
GpuScene build_gpu_scene(const Scene& scene);

}  // namespace candela
