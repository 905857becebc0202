// Surfaces and trees -> the arrays of nodes, and of what lies in leaf order.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gpu_scene/area_lights.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/lamps.h"
#include "gpu_scene/mesh_trees.h"
#include "gpu_scene/scene_tree.h"
#include "shared/kernel_constants.h"

namespace candela {

// A mesh with a tree of its own: its primitives in leaf order, and its triangles.
struct InstancedMesh {
    uint32_t first_primitive = 0;
    uint32_t primitives = 0;
    uint64_t triangles = 0;
};

// An instance: the place of its record among the nodes, its mesh in LeafFacts::meshes, and its shape in the
// scene.
struct InstancePlace {
    uint32_t node = 0;
    uint32_t mesh = 0;
    uint32_t shape = 0;
};

struct LeafFacts {
    uint32_t primitive_count = 0;       // Two triangles may be one: see shared/primitive.h.
    uint32_t baked_primitives = 0;      // The first of them, which lie in the frame of the scene; the others,
    std::vector<InstancedMesh> meshes;  // in meshes' own spaces, are seen in instances.
    uint32_t primitives_present = 0;    // Bit i: a primitive of kind i.
    bool has_normals = false;
    std::array<uint32_t, LIST_MAX> list_corners{};  // Of the first primitives; see LIST_CORNERS_0.
};

struct LeafArrays {
    LeafFacts facts;
    std::vector<uvec4> primitives, surfaces, normals, attributes;
};

// Everything that lies in leaf order: the primitives of `flat` in the order of the tree above, then those of
// meshes, if the tree has instances. The lights of pieces are those of `area`, and of `lamps`, for which they
// begin at 0.
LeafArrays build_leaf_arrays(const FlatScene& flat, const AreaLights& area, const SceneTree& tree,
                             const MeshTrees& trees, const Lamps& lamps, uint attributes);

struct NodeFacts {
    std::vector<InstancePlace> instances{};
    std::vector<ShapeIds> shape_ids{};  // Of the shapes that are no instances.
    uint32_t id_count = 0;              // Triangles, spheres and disks; modulo 2^32.
    uint32_t bvh_depth = 1;             // Levels of nodes; an instance is one, and those of its mesh follow.
    float bvh_sah_cost = 0.0f;
};

struct NodeArrays {
    NodeFacts facts{};
    std::vector<uvec4> nodes{};
};

// The nodes of the tree above, and then those of meshes, if it has instances. Ids of instances follow those
// of `flat`. Throws Error if there are more nodes or primitives than a tree may have.
NodeArrays build_node_arrays(const FlatScene& flat, const SceneTree& tree, const MeshTrees& trees);

// Warnings about triangles and spheres that are too small for the floats of the frame.
std::vector<std::string> warn_of_small_shapes(const SceneFrame& frame, const FlatScene& flat,
                                              const MeshTrees& trees);

}  // namespace candela
