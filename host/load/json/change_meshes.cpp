// See change_meshes.h.
#include "load/json/change_meshes.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "base/text.h"
#include "load/json/loader_parts.h"
#include "load/quote.h"
#include "scene/mesh.h"
#include "scene/place.h"
#include "scene/scene_builder.h"

namespace candela {
namespace {

// The mesh of a shape, also of one that is hidden.
std::optional<uint32_t> own_mesh(const Shape& shape) {
    const Geometry own = origin_of(shape).geometry;
    const auto* const instance = std::get_if<MeshInstance>(&own);
    return instance != nullptr ? std::optional(instance->mesh) : std::nullopt;
}

// The mesh of the object of that name; none if it is something else, too, or shares it with others of a file.
std::optional<uint32_t> mesh_of(std::string_view object, const Scene& scene) {
    std::set<std::optional<uint32_t>> meshes;
    for (const Shape& shape : scene.shapes) {
        if (shape.object != NO_OBJECT && scene.objects[shape.object] == object)
            meshes.insert(own_mesh(shape));
    }
    if (meshes.size() != 1 || !*meshes.begin() || !scene.meshes[**meshes.begin()].groups.empty())
        return std::nullopt;
    return *meshes.begin();
}

// Makes a mesh what all shapes need that show it.
void finish(const Node& node, const Scene& scene, Scene& change, ChangedMesh& made) {
    const size_t dropped = drop_flat_triangles(made.now);
    if (made.now.triangles.empty()) node.fail("the mesh has no triangle with an area; check its positions");
    if (dropped > 0) {
        change.warnings.push_back(concat(node.place(), ": left out ", dropped,
                                         dropped == 1 ? " triangle" : " triangles", " without area"));
    }
    for (const Shape& shape : scene.shapes) {
        if (own_mesh(shape) != made.mesh) continue;
        const auto* const instance = std::get_if<MeshInstance>(&shape.geometry);
        if (shape.visible && instance != nullptr && !reaches_no_farther(made.now, instance->transform))
            node.fail(TOO_FAR);
        finish_mesh(scene, node.place(), {shape.material, shape.emission, shape.states_emission}, made.now);
    }
}

}  // namespace

std::vector<ChangedMesh> read_mesh_changes(const Node& meshes, const Scene& scene, Scene& change) {
    std::vector<ChangedMesh> changes;
    for (const Node& node : meshes.members()) {
        node.allow_only({}, keys_of({"mesh"}));
        if (std::ranges::find(scene.objects, node.key()) == scene.objects.end())
            node.fail_unknown("object", node.key(), scene.objects, "defined");
        const std::optional<uint32_t> mesh = mesh_of(node.key(), scene);
        if (!mesh) {
            node.fail(concat("the object ", quote(node.key()),
                             " is not one mesh of its own; change the scene's file, and load it again"));
        }
        changes.push_back({*mesh, read_triangle_mesh(node, change)});
        finish(node, scene, change, changes.back());
    }
    return changes;
}

void take_meshes(std::vector<ChangedMesh> meshes, Scene& scene, SceneChange& change) {
    for (ChangedMesh& made : meshes) {
        if (is_same(scene.meshes[made.mesh], made.now)) continue;
        scene.meshes[made.mesh] = std::move(made.now);
        change.meshes.push_back(made.mesh);
    }
}

void carry_mesh(std::string_view object, const Scene& from, Scene& to) {
    const std::optional<uint32_t> source = mesh_of(object, from), target = mesh_of(object, to);
    if (source && target) to.meshes[*target] = from.meshes[*source];
}

}  // namespace candela
