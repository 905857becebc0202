// See scene_tree.h.
#include "gpu_scene/scene_tree.h"

#include <utility>
#include <variant>

#include "bvh/two_levels.h"

namespace candela {

SceneTree build_scene_tree(const Scene& scene, const SceneFrame& frame, const FlatScene& flat,
                           const Instancing& instancing, const MeshTrees& trees) {
    SceneTree tree;
    std::vector<Box> boxes = boxes_of(flat.primitives);
    for (const uint32_t i : instancing.shapes) {
        const auto& instance = std::get<MeshInstance>(scene.shapes[i].geometry);
        const MeshTree& mesh = trees.at(instance.mesh);
        if (mesh.boxes.empty()) continue;
        const PlacedInstance placed = place_instance(instance.transform, frame, mesh.frame, mesh.boxes);
        boxes.push_back(placed.box);
        Instance record = placed.record;
        record.material = scene.shapes[i].material;
        tree.instances.push_back({.mesh = instance.mesh, .record = record});
    }
    Bvh bvh = build_bvh(boxes);
    tree.bounds = bvh.bounds;
    tree.sah_cost = bvh.sah_cost;
    tree.depth = bvh.depth;
    if (tree.instances.empty()) {
        tree.nodes = std::move(bvh.nodes);
        tree.order = std::move(bvh.order);
        return tree;
    }
    TwoLevelTree top = separate_instances(bvh, uint32_t(flat.primitives.size()));
    for (size_t i = 0; i < tree.instances.size(); ++i) {
        tree.instances[i].node = top.instance_nodes[i];
        tree.instances[i].level = top.instance_levels[i];
    }
    tree.depth = top.depth;
    tree.nodes = std::move(top.nodes);
    tree.order = std::move(top.order);
    return tree;
}

}  // namespace candela
