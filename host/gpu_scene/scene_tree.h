// The tree above: over all surfaces in the frame of the scene, and over instances.
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/bvh.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/instancing.h"
#include "gpu_scene/mesh_trees.h"
#include "scene/frame.h"
#include "scene/scene.h"
#include "shared/instance.h"

namespace candela {

// A mesh in its place: the record of the instance, and where that goes.
struct TreeInstance {
    ShownMesh mesh;
    Box box;             // Around it, in the frame of the scene.
    Instance record;     // `root`, `first_id` and `lamp` are not set.
    uint32_t shape = 0;  // Its index in the scene.
    uint32_t node = 0;   // Its place among the nodes,
    uint32_t level = 0;  // and its level: the root has level 1.
};

struct SceneTree {
    std::vector<PackedBvhNode> nodes{};
    std::vector<uint32_t> order{};          // The flat scene's primitives in leaf order.
    std::vector<TreeInstance> instances{};  // Those that rays can meet, in the order of the scene.
    Box bounds{};
    uint32_t depth = 0;     // Nodes on the longest way down to a primitive, or to an instance and its record.
    float sah_cost = 0.0f;  // As of a Bvh.
};

// `kept`: the tree over the surfaces, whose children are sorted. It then becomes a part of the tree above,
// which costs little to build; if there are no instances, it is not used. Null: all of the tree is built.
SceneTree build_scene_tree(const Scene& scene, const SceneFrame& frame, const FlatScene& flat,
                           const Instancing& instancing, const MeshTrees& trees, const Bvh* kept = nullptr);

}  // namespace candela
