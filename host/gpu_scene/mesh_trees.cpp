// See mesh_trees.h.
#include "gpu_scene/mesh_trees.h"

#include <utility>

#include "bvh/two_levels.h"
#include "gpu_scene/choose_frame.h"
#include "gpu_scene/material_arrays.h"
#include "shared/bvh_node.h"

namespace candela {
namespace {

// Boxes of a tree's nodes two levels down, or of what is above: they lie closer around it than one box.
std::vector<Box> upper_boxes(const Bvh& bvh) {
    std::vector<Box> boxes;
    const BvhNode root = unpack(bvh.nodes[0]);
    for (uint32_t i = 0; i < bvh_child_count(root); ++i) {
        const uint32_t child = bvh_child(root.children, i);
        if (is_leaf(child)) {
            boxes.push_back(child_box(root, i));
            continue;
        }
        const BvhNode node = unpack(bvh.nodes[child]);
        for (uint32_t k = 0; k < bvh_child_count(node); ++k)
            boxes.push_back(child_box(node, k));
    }
    return boxes;
}

MeshTree build_mesh_tree(const Scene& scene, const ShownMesh& shown, uint attributes, bool passable,
                         bool normals) {
    MeshTree tree{.passable = passable};
    tree.frame = frame_around(scene.meshes[shown.mesh]);
    tree.flat = flatten_mesh(scene, shown, passable, tree.frame, attributes, normals);
    tree.bvh = build_bvh(boxes_of(tree.flat.primitives));
    if (!tree.flat.primitives.empty()) tree.boxes = upper_boxes(tree.bvh);
    sort_children(tree.bvh);
    return tree;
}

}  // namespace

MeshTrees build_mesh_trees(const Scene& scene, const Instancing& instancing, uint attributes,
                           MeshTrees&& known) {
    std::map<ShownMesh, bool> passable;
    for (size_t i = 0; i < instancing.shapes.size(); ++i) {
        bool& passes = passable[instancing.shown[i]];
        passes = passes || lets_rays_pass(scene, scene.shapes[instancing.shapes[i]]);
    }
    const bool normals = has_shading_normals(scene);
    MeshTrees trees;
    for (const ShownMesh& mesh : instancing.meshes) {
        const auto before = known.find(mesh);
        const bool stays = before != known.end() && before->second.passable == passable[mesh];
        trees.emplace(mesh, stays ? std::move(before->second)
                                  : build_mesh_tree(scene, mesh, attributes, passable[mesh], normals));
    }
    return trees;
}

}  // namespace candela
