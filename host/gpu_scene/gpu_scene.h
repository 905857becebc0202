// Scene -> records: the arrays that the device reads, made without any device.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "gpu_scene/choose_frame.h"
#include "gpu_scene/instancing.h"
#include "scene/scene.h"
#include "shared/kernel_constants.h"
#include "shared/parameters.h"
#include "shared/scene_arrays.h"

namespace candela {

// A mesh with a tree of its own: its primitives in leaf order, and its triangles.
struct InstancedMesh {
    uint32_t first_primitive = 0;
    uint32_t primitives = 0;
    uint64_t triangles = 0;
};

// An instance: the place of its record among the nodes, and its mesh in GpuScene::meshes.
struct InstancePlace {
    uint32_t node = 0;
    uint32_t mesh = 0;
};

struct GpuScene {
    SceneFrame frame;  // Of all lengths and points below.

    // Records as shared/*.h describe them, in words of uvec4, by ARRAY_*.
    std::array<std::vector<uvec4>, ARRAY_COUNT> arrays;

    uint32_t primitive_count = 0;       // Two triangles may be one: see shared/primitive.h.
    uint32_t baked_primitives = 0;      // The first of them, which lie in the frame of the scene; the others,
    std::vector<InstancedMesh> meshes;  // in meshes' own spaces,
    std::vector<InstancePlace> instances;  // are seen in instances.
    uint32_t id_count = 0;                 // Triangles, spheres and disks; modulo 2^32.
    uint32_t light_count = 0;
    uint32_t material_count = 0;
    LightGroups light_groups{};
    uvec2 environment_size{0};          // Texels.
    float environment_rotation = 0.0f;  // [rad]

    // What the kernels must know: see shared/kernel_constants.inc.
    bool has_normals = false;
    bool has_media = false;     // Some medium absorbs light.
    bool nested_media = false;  // Media may lie within each other.
    uint32_t environment = ENVIRONMENT_NONE;
    bool even_sky = false;
    uint32_t materials_present = 0;                 // Bit i: a material of model i.
    uint32_t principled = 0;                        // Bits PRINCIPLED_HAS_*: of all principled materials.
    uint32_t primitives_present = 0;                // Bit i: a primitive of kind i.
    uint32_t lights_present = 0;                    // Bit i: a light of kind i.
    uint32_t attributes = 0;                        // Bits ATTRIBUTE_*.
    uint32_t textured = 0;                          // Bits TEXTURED_*.
    uint32_t texture_traits = 0;                    // Of all textures.
    std::array<uint32_t, LIST_MAX> list_corners{};  // Of the first primitives; see LIST_CORNERS_0.

    uint32_t bvh_depth = 1;  // Levels of nodes; an instance is one, and those of its mesh follow.

    std::vector<std::string> warnings;  // What is lost on the way from the scene.

    // About the BVH, for reports.
    float bvh_sah_cost = 0.0f;
    double bvh_seconds = 0.0;  // Wall time of building it, and of placing instances.

    // Bytes that the arrays take on a device.
    uint64_t bytes() const;
};

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
