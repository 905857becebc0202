// See geometry_arrays.h.
#include "gpu_scene/geometry_arrays.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "base/text.h"
#include "bvh/bvh.h"
#include "bvh/two_levels.h"
#include "gpu_scene/append.h"
#include "scene/mesh.h"
#include "shared/bvh_node.h"
#include "shared/primitive.h"

namespace candela {
namespace {

std::vector<Box> boxes_of(const std::vector<Primitive>& primitives) {
    std::vector<Box> boxes;
    boxes.reserve(primitives.size());
    for (const Primitive& primitive : primitives)
        boxes.push_back(bounds(primitive));
    return boxes;
}

// For each corner of the first primitives in leaf order, the first corner with the same bits.
std::array<uint32_t, LIST_MAX> list_corners(const std::vector<Primitive>& primitives,
                                            std::span<const uint32_t> order) {
    std::array<uint32_t, LIST_MAX> result{};
    std::vector<std::array<uint32_t, 3>> corners;
    for (size_t i = 0; i < std::min<size_t>(order.size(), LIST_MAX); ++i) {
        const Primitive& p = primitives[order[i]];
        for (const vec3& corner : {p.a, p.b, p.c, p.d}) {
            corners.push_back(std::bit_cast<std::array<uint32_t, 3>>(corner));
            const auto first = uint32_t(std::ranges::find(corners, corners.back()) - corners.begin());
            result[i] |= first << 8u * ((corners.size() - 1) % 4);
        }
    }
    return result;
}

void reserve_leaves(GpuScene& gpu, size_t count, bool normals) {
    if (normals) gpu.arrays[ARRAY_NORMALS].reserve(count * NORMALS_WORDS);
    gpu.arrays[ARRAY_PRIMITIVES].reserve(count * PRIMITIVE_WORDS);
    gpu.arrays[ARRAY_SURFACES].reserve(count * SURFACE_WORDS);
    gpu.arrays[ARRAY_ATTRIBUTES].reserve(count * attribute_words(gpu.attributes));
}

// Appends the primitives of a tree, and what else lies in leaf order.
void append_leaves(GpuScene& gpu, const FlatScene& flat, std::span<const uint32_t> order) {
    for (const uint32_t i : order) {
        append(gpu.arrays[ARRAY_PRIMITIVES], pack(flat.primitives[i]));
        append(gpu.arrays[ARRAY_SURFACES], pack(flat.surfaces[i]));
        if (!flat.normals.empty()) append(gpu.arrays[ARRAY_NORMALS], flat.normals[i]);
        const size_t words = attribute_words(gpu.attributes);
        append(gpu.arrays[ARRAY_ATTRIBUTES], std::span(flat.attributes).subspan(i * words, words));
        gpu.primitives_present |= 1u << flat.primitives[i].kind;
    }
    gpu.primitive_count += uint32_t(order.size());
}

// A mesh with a tree of its own.
struct MeshTree {
    SceneFrame frame;
    FlatScene flat;
    Bvh bvh;
    std::vector<Box> boxes;  // Which together contain the mesh.
};

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

MeshTree build_mesh_tree(const GpuScene& gpu, const Scene& scene, uint32_t mesh, bool lets_pass,
                         bool normals) {
    MeshTree tree;
    DoubleBox box;
    const TriangleMesh& m = scene.meshes[mesh];
    for (const vec3 p : m.positions)
        box.extend(m.origin + dvec3(p));
    tree.frame = frame_around(box);
    tree.flat =
        flatten_mesh(scene, MeshInstance{.mesh = mesh}, lets_pass, tree.frame, gpu.attributes, normals);
    tree.bvh = build_bvh(boxes_of(tree.flat.primitives));
    if (!tree.flat.primitives.empty()) tree.boxes = upper_boxes(tree.bvh);
    return tree;
}

// The trees of the meshes that instances show, by the meshes' indices.
std::map<uint32_t, MeshTree> build_mesh_trees(const GpuScene& gpu, const Scene& scene,
                                              const Instancing& instancing) {
    std::map<uint32_t, bool> lets_pass;
    for (const uint32_t i : instancing.shapes) {
        const Shape& shape = scene.shapes[i];
        bool& passes = lets_pass[std::get<MeshInstance>(shape.geometry).mesh];
        passes = passes || lets_rays_pass(scene, shape);
    }
    const bool normals = has_shading_normals(scene);
    std::map<uint32_t, MeshTree> trees;
    for (const uint32_t mesh : instancing.meshes)
        trees.emplace(mesh, build_mesh_tree(gpu, scene, mesh, lets_pass[mesh], normals));
    return trees;
}

// The instances of meshes that rays can meet.
struct Instances {
    std::vector<const Shape*> shapes;
    std::vector<PlacedInstance> placed;

    uint32_t mesh(size_t i) const { return std::get<MeshInstance>(shapes[i]->geometry).mesh; }
};

Instances place_instances(const GpuScene& gpu, const Scene& scene, const Instancing& instancing,
                          const std::map<uint32_t, MeshTree>& trees) {
    Instances instances;
    for (const uint32_t i : instancing.shapes) {
        const auto& instance = std::get<MeshInstance>(scene.shapes[i].geometry);
        const MeshTree& tree = trees.at(instance.mesh);
        if (tree.boxes.empty()) continue;
        instances.shapes.push_back(&scene.shapes[i]);
        instances.placed.push_back(place_instance(instance.transform, gpu.frame, tree.frame, tree.boxes));
    }
    return instances;
}

// Appends the trees of meshes to the nodes, and their leaves to the arrays. Returns the places of their
// roots.
std::map<uint32_t, uint32_t> append_mesh_trees(GpuScene& gpu, std::vector<PackedBvhNode>& nodes,
                                               const std::map<uint32_t, MeshTree>& trees) {
    std::map<uint32_t, uint32_t> roots;
    for (const auto& [mesh, tree] : trees) {
        roots[mesh] = append_tree(nodes, gpu.primitive_count, tree.bvh);
        gpu.meshes.push_back({gpu.primitive_count, uint32_t(tree.bvh.order.size()), tree.flat.triangles});
        append_leaves(gpu, tree.flat, tree.bvh.order);
    }
    return roots;
}

// Writes the records of instances in their places among the nodes.
void put_instances(GpuScene& gpu, const Instances& instances, const TwoLevelTree& top,
                   const std::map<uint32_t, uint32_t>& roots, const std::map<uint32_t, MeshTree>& trees,
                   std::vector<PackedBvhNode>& nodes) {
    for (size_t i = 0; i < instances.shapes.size(); ++i) {
        const uint32_t mesh = instances.mesh(i);
        const MeshTree& tree = trees.at(mesh);
        Instance record = instances.placed[i].record;
        record.root = roots.at(mesh);
        record.first_id = gpu.id_count;
        record.material = instances.shapes[i]->material;
        nodes[top.instance_nodes[i]] = pack(record);
        gpu.id_count += tree.flat.id_count;
        gpu.bvh_depth = std::max(gpu.bvh_depth, top.instance_levels[i] + tree.bvh.depth);
        gpu.instances.push_back(
            {top.instance_nodes[i], uint32_t(std::distance(trees.begin(), trees.find(mesh)))});
    }
}

void warn_of_small_shapes(GpuScene& gpu, const FlatScene& flat, const std::map<uint32_t, MeshTree>& trees) {
    uint64_t triangles = flat.triangles, coarse = flat.coarse, flattened = flat.flattened;
    for (const auto& [mesh, tree] : trees) {
        triangles += tree.flat.triangles;
        coarse += tree.flat.coarse;
        flattened += tree.flat.flattened;
    }
    if (is_too_coarse(coarse, triangles)) {
        gpu.warnings.push_back(
            std::to_string(coarse) + " of " + std::to_string(triangles) +
            " triangles are smaller than 16 steps of 32-bit coordinates in a scene of this "
            "size, " +
            number_text(gpu.frame.unit, 3) + " m: they look rough; render what is far apart by itself");
    }
    if (is_too_coarse(flat.coarse_spheres, flat.spheres)) {
        gpu.warnings.push_back(
            std::to_string(flat.coarse_spheres) + " of " + std::to_string(flat.spheres) +
            " spheres are too small for 32-bit coordinates in a scene of this size, " +
            number_text(gpu.frame.unit, 3) +
            " m: rounding moves them by more than 3 % of their radius; render what is far apart by itself");
    }
    if (flattened > 0) {
        gpu.warnings.push_back("left out " + std::to_string(flattened) +
                               (flattened == 1 ? " triangle" : " triangles") +
                               " too small for 32-bit coordinates in a scene of this size");
    }
}

}  // namespace

SceneTree append_geometry(GpuScene& gpu, const Scene& scene, const FlatScene& flat,
                          const Instancing& instancing) {
    const auto start = std::chrono::steady_clock::now();
    gpu.id_count = flat.id_count;
    const std::map<uint32_t, MeshTree> trees = build_mesh_trees(gpu, scene, instancing);
    const Instances instances = place_instances(gpu, scene, instancing, trees);
    warn_of_small_shapes(gpu, flat, trees);

    std::vector<Box> boxes = boxes_of(flat.primitives);
    for (const PlacedInstance& placed : instances.placed)
        boxes.push_back(placed.box);
    Bvh bvh = build_bvh(boxes);
    gpu.bvh_sah_cost = bvh.sah_cost;
    gpu.bvh_depth = bvh.depth;
    if (instances.shapes.empty()) {
        reserve_leaves(gpu, bvh.order.size(), !flat.normals.empty());
        append_leaves(gpu, flat, bvh.order);
        gpu.list_corners = list_corners(flat.primitives, bvh.order);
    } else {
        TwoLevelTree top = separate_instances(bvh, uint32_t(flat.primitives.size()));
        gpu.bvh_depth = top.depth;
        size_t leaves = top.order.size();
        for (const auto& [mesh, tree] : trees)
            leaves += tree.bvh.order.size();
        reserve_leaves(gpu, leaves, has_shading_normals(scene));
        append_leaves(gpu, flat, top.order);
        std::vector<PackedBvhNode> nodes = std::move(top.nodes);
        const std::map<uint32_t, uint32_t> roots = append_mesh_trees(gpu, nodes, trees);
        put_instances(gpu, instances, top, roots, trees, nodes);
        bvh.nodes = std::move(nodes);
        bvh.order = std::move(top.order);
    }
    gpu.has_normals = !gpu.arrays[ARRAY_NORMALS].empty();
    gpu.baked_primitives = uint32_t(bvh.order.size());
    gpu.arrays[ARRAY_NODES].reserve(bvh.nodes.size() * BVH_NODE_WORDS);
    for (const PackedBvhNode& node : bvh.nodes)
        append(gpu.arrays[ARRAY_NODES], node);
    if (gpu.primitive_count == 0)
        gpu.arrays[ARRAY_PRIMITIVES].resize(PRIMITIVE_WORDS);  // Traversal may read it all the same.
    gpu.bvh_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return {std::move(bvh.order), bvh.bounds};
}

}  // namespace candela
