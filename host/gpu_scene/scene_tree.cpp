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
    for (size_t i = 0; i < instancing.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[instancing.shapes[i]];
        const auto& instance = std::get<MeshInstance>(shape.geometry);
        const MeshTree& mesh = trees.at(instancing.shown[i]);
        if (mesh.boxes.empty()) continue;
        const PlacedInstance placed = place_instance(instance.transform, frame, mesh.frame, mesh.boxes);
        boxes.push_back(placed.box);
        Instance record = placed.record;
        record.material = shape.material;
        tree.instances.push_back({.mesh = instancing.shown[i],
                                  .box = placed.box,
                                  .record = record,
                                  .shape = instancing.shapes[i]});
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
