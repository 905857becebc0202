// See scene_tree.h.
#include "gpu_scene/scene_tree.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "bvh/two_levels.h"

namespace candela {
namespace {

std::vector<TreeInstance> place_instances(const Scene& scene, const SceneFrame& frame,
                                          const Instancing& instancing, const MeshTrees& trees) {
    std::vector<TreeInstance> instances;
    for (size_t i = 0; i < instancing.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[instancing.shapes[i]];
        const auto& instance = std::get<MeshInstance>(shape.geometry);
        const MeshTree& mesh = trees.at(instancing.shown[i]);
        if (mesh.boxes.empty()) continue;
        const PlacedInstance placed = place_instance(instance.transform, frame, mesh.frame, mesh.boxes);
        Instance record = placed.record;
        record.material = shape.material;
        instances.push_back({.mesh = instancing.shown[i],
                             .box = placed.box,
                             .record = record,
                             .shape = instancing.shapes[i]});
    }
    return instances;
}

// Puts a tree in the place of a node that has been made for it at that level.
void graft(TwoLevelTree& top, uint32_t node, uint32_t level, const Bvh& tree) {
    const uint32_t root = append_tree(top.nodes, 0, tree);
    top.nodes[node] = top.nodes[root];
    top.order = tree.order;
    top.depth = std::max(top.depth, level + tree.depth - 1);
}

}  // namespace

SceneTree build_scene_tree(const Scene& scene, const SceneFrame& frame, const FlatScene& flat,
                           const Instancing& instancing, const MeshTrees& trees, const Bvh* kept) {
    SceneTree tree{.instances = place_instances(scene, frame, instancing, trees)};
    if (tree.instances.empty()) kept = nullptr;
    std::vector<Box> boxes = kept != nullptr ? std::vector<Box>() : boxes_of(flat.primitives);
    const auto primitives = uint32_t(boxes.size());
    for (const TreeInstance& instance : tree.instances)
        boxes.push_back(instance.box);
    if (kept != nullptr) boxes.push_back(kept->bounds);
    Bvh bvh = build_bvh(boxes);
    tree.bounds = bvh.bounds;
    tree.sah_cost = bvh.sah_cost;
    tree.depth = bvh.depth;
    if (tree.instances.empty()) {
        tree.nodes = std::move(bvh.nodes);
        tree.order = std::move(bvh.order);
        return tree;
    }
    TwoLevelTree top = separate_instances(bvh, primitives);
    for (size_t i = 0; i < tree.instances.size(); ++i) {
        tree.instances[i].node = top.instance_nodes[i];
        tree.instances[i].level = top.instance_levels[i];
    }
    if (kept != nullptr) graft(top, top.instance_nodes.back(), top.instance_levels.back(), *kept);
    tree.depth = top.depth;
    tree.nodes = std::move(top.nodes);
    tree.order = std::move(top.order);
    return tree;
}

}  // namespace candela
