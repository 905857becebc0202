// Scene -> records: the arrays that the device reads, made without any device.
#pragma once

#include <array>
#include <bitset>
#include <string>
#include <vector>

#include "gpu_scene/choose_frame.h"
#include "gpu_scene/environment_map.h"
#include "gpu_scene/geometry_arrays.h"
#include "gpu_scene/instancing.h"
#include "gpu_scene/light_arrays.h"
#include "gpu_scene/material_arrays.h"
#include "gpu_scene/words.h"
#include "scene/frame.h"
#include "scene/scene.h"
#include "shared/scene_arrays.h"

namespace candela {

// The parts of a scene, joined: what kernels must know of each, and the arrays of all.
struct GpuScene : MaterialFacts, LeafFacts, NodeFacts, LightFacts, SkyFacts {
    SceneFrame frame;           // Of all lengths and points.
    bool nested_media = false;  // Media may lie within each other.
    bool sealed_media = false;  // See Nesting::sealed.

    // Records as shared/*.h describe them, in words of uvec4, by ARRAY_*.
    std::array<Words, ARRAY_COUNT> arrays;

    std::vector<std::string> warnings;  // What is lost on the way from the scene.
    double bvh_seconds = 0.0;           // Wall time of building trees, and of placing instances.

    // Bytes that the arrays take on a device.
    uint64_t bytes() const;
};

// Some of the buffers that hold a scene's arrays, by BUFFER_*.
using BufferSet = std::bitset<BUFFER_COUNT>;

// Those in which `now` may have other words than `before`: those whose arrays are not shared.
BufferSet changed_buffers(const GpuScene& before, const GpuScene& now);

// The record of an instance of the scene.
Instance instance_at(const GpuScene& scene, const InstancePlace& place);

// Flattens the shapes into primitives, builds the BVH and packs everything. Throws Error if the scene has
// more primitives than a BVH can address.
// The records are in the frame that choose_frame() chooses, or in `frame`; `rule` says which meshes get a
// tree of their own.
GpuScene build_gpu_scene(const Scene& scene);
GpuScene build_gpu_scene(const Scene& scene, const SceneFrame& frame, const InstancingRule& rule = {});

// build_gpu_scene(), for the last use of the scene's images: each loses its texels as soon as they are
// packed, so that memory does not hold them all twice, unless others share them.
GpuScene build_gpu_scene_freeing_images(Scene& scene);

}  // namespace candela
