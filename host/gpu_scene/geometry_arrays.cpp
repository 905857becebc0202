// See geometry_arrays.h.
#include "gpu_scene/geometry_arrays.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <map>

#include "base/text.h"
#include "bvh/two_levels.h"
#include "gpu_scene/append.h"
#include "scene/mesh.h"
#include "shared/bvh_node.h"
#include "shared/light.h"
#include "shared/primitive.h"

namespace candela {
namespace {

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

// Appends the primitives of a tree, and what else lies in leaf order.
void append_leaves(LeafArrays& leaves, const FlatScene& flat, std::span<const uint32_t> light_of_pieces,
                   std::span<const uint32_t> order, size_t attribute_words) {
    for (const uint32_t i : order) {
        Surface surface = flat.surfaces[i];
        if (surface.light != NO_LIGHT) surface.light = light_of_pieces[surface.light];
        append(leaves.primitives, pack(flat.primitives[i]));
        append(leaves.surfaces, pack(surface));
        if (!flat.normals.empty()) append(leaves.normals, flat.normals[i]);
        append(leaves.attributes, std::span(flat.attributes).subspan(i * attribute_words, attribute_words));
        leaves.facts.primitives_present |= 1u << flat.primitives[i].kind;
    }
    leaves.facts.primitive_count += uint32_t(order.size());
}

}  // namespace

LeafArrays build_leaf_arrays(const FlatScene& flat, const AreaLights& area, const SceneTree& tree,
                             const MeshTrees& trees, const Lamps& lamps, uint attributes) {
    const size_t words = attribute_words(attributes);
    const bool instanced = !tree.instances.empty();
    size_t count = tree.order.size();
    bool normals = !flat.normals.empty();
    for (const auto& [mesh, own] : trees) {
        count += instanced ? own.bvh.order.size() : 0;
        normals = normals || (instanced && !own.flat.normals.empty());
    }
    LeafArrays leaves;
    leaves.primitives.reserve(count * PRIMITIVE_WORDS);
    leaves.surfaces.reserve(count * SURFACE_WORDS);
    leaves.normals.reserve(normals ? count * NORMALS_WORDS : 0);
    leaves.attributes.reserve(count * words);
    append_leaves(leaves, flat, area.of_pieces, tree.order, words);
    leaves.facts.baked_primitives = leaves.facts.primitive_count;
    for (const auto& [mesh, own] : trees) {
        if (!instanced) break;
        leaves.facts.meshes.push_back(
            {leaves.facts.primitive_count, uint32_t(own.bvh.order.size()), own.flat.triangles});
        const auto lamp = lamps.find(mesh);
        const auto light_of_pieces =
            lamp == lamps.end() ? std::span<const uint32_t>() : lamp->second.area.of_pieces;
        append_leaves(leaves, own.flat, light_of_pieces, own.bvh.order, words);
    }
    if (!instanced) leaves.facts.list_corners = list_corners(flat.primitives, tree.order);
    leaves.facts.has_normals = !leaves.normals.empty();
    if (leaves.facts.primitive_count == 0)
        leaves.primitives.resize(PRIMITIVE_WORDS);  // Traversal may read it all the same.
    return leaves;
}

NodeArrays build_node_arrays(const FlatScene& flat, const SceneTree& tree, const MeshTrees& trees) {
    NodeArrays result{.facts = {.shape_ids = flat.shape_ids,
                                .id_count = flat.id_count,
                                .bvh_depth = tree.depth,
                                .bvh_sah_cost = tree.sah_cost}};
    std::vector<PackedBvhNode> nodes = tree.nodes;
    std::map<ShownMesh, uint32_t> roots;
    uint64_t primitives = tree.order.size();
    for (const auto& [mesh, own] : trees) {
        if (tree.instances.empty()) break;
        roots[mesh] = append_tree(nodes, primitives, own.bvh);
        primitives += own.bvh.order.size();
    }
    for (const TreeInstance& instance : tree.instances) {
        const auto own = trees.find(instance.mesh);
        Instance record = instance.record;
        record.root = roots.at(instance.mesh);
        record.first_id = result.facts.id_count;
        nodes[instance.node] = pack(record);
        result.facts.id_count += own->second.flat.id_count;
        result.facts.bvh_depth = std::max(result.facts.bvh_depth, instance.level + own->second.bvh.depth);
        result.facts.instances.push_back(
            {instance.node, uint32_t(std::distance(trees.begin(), own)), instance.shape});
    }
    result.nodes.reserve(nodes.size() * BVH_NODE_WORDS);
    for (const PackedBvhNode& node : nodes)
        append(result.nodes, node);
    return result;
}

std::vector<std::string> warn_of_small_shapes(const SceneFrame& frame, const FlatScene& flat,
                                              const MeshTrees& trees) {
    std::vector<std::string> warnings;
    uint64_t triangles = flat.triangles, coarse = flat.coarse, flattened = flat.flattened;
    for (const auto& [mesh, tree] : trees) {
        triangles += tree.flat.triangles;
        coarse += tree.flat.coarse;
        flattened += tree.flat.flattened;
    }
    if (is_too_coarse(coarse, triangles)) {
        warnings.push_back(std::to_string(coarse) + " of " + std::to_string(triangles) +
                           " triangles are smaller than 16 steps of 32-bit coordinates in a scene of this "
                           "size, " +
                           number_text(frame.unit, 3) +
                           " m: they look rough; render what is far apart by itself");
    }
    if (is_too_coarse(flat.coarse_spheres, flat.spheres)) {
        warnings.push_back(
            std::to_string(flat.coarse_spheres) + " of " + std::to_string(flat.spheres) +
            " spheres are too small for 32-bit coordinates in a scene of this size, " +
            number_text(frame.unit, 3) +
            " m: rounding moves them by more than 3 % of their radius; render what is far apart by itself");
    }
    if (flattened > 0) {
        warnings.push_back("left out " + std::to_string(flattened) +
                           (flattened == 1 ? " triangle" : " triangles") +
                           " too small for 32-bit coordinates in a scene of this size");
    }
    return warnings;
}

}  // namespace candela
