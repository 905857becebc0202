// Shapes -> the arrays of nodes and of what lies in leaf order.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu_scene/flatten.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/instancing.h"

namespace candela {

// The tree over all surfaces in the frame of the scene, and over instances.
struct SceneTree {
    std::vector<uint32_t> order;  // The flat scene's primitives in leaf order.
    Box bounds;
};

// Builds the tree over `flat`, and over the instances of meshes with trees of their own, and appends them to
// the arrays; sets what GpuScene says of them. Adds warnings about triangles that are too small.
SceneTree append_geometry(GpuScene& gpu, const Scene& scene, const FlatScene& flat,
                          const Instancing& instancing);

}  // namespace candela
