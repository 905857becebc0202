// See change_objects.h.
#include "load/json/change_objects.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "load/json/transforms.h"
#include "load/quote.h"
#include "scene/place.h"
#include "scene/scene_builder.h"

namespace candela {
namespace {

// The numbers of instances by the object's name, of objects with shapes of their own.
std::map<std::string, std::set<uint32_t>> instances_of(const Scene& scene) {
    std::map<std::string, std::set<uint32_t>> instances;
    for (const Shape& shape : scene.shapes) {
        if (shape.object != NO_OBJECT) instances[scene.objects[shape.object]].insert(shape.copy);
    }
    return instances;
}

InstanceEdit read_edit(const Node& node) {
    InstanceEdit edit;
    if (const auto transform = node.find("transform")) edit.transform = read_transform(*transform);
    if (const auto visible = node.find("visible")) edit.visible = visible->boolean();
    return edit;
}

// The number of an instance that is the key of a value.
uint32_t number_of(const Node& node, const std::set<uint32_t>& known) {
    const std::string_view key = node.key();
    uint32_t number = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
    if (error != std::errc() || end != key.data() + key.size() || !known.contains(number)) {
        node.fail(concat("expected the number of an instance, from 0 to ", *known.rbegin(), ", found ",
                         quote(key)));
    }
    return number;
}

void read_object(const Node& node, const std::set<uint32_t>& instances, InstanceEdits& edits) {
    node.allow_only({"transform", "visible", "instances"});
    const std::string name(node.key());
    const InstanceEdit edit = read_edit(node);
    if (edit.transform && instances.size() > 1) {
        node.require("transform")
            .fail(concat("the object ", quote(name), " is shown ", instances.size(),
                         " times; give the transforms of its \"instances\""));
    }
    for (const uint32_t copy : instances)
        edits[{name, copy}] = edit;
    const auto some = node.find("instances");
    if (!some) return;
    for (const Node& instance : some->members()) {
        instance.allow_only({"transform", "visible"});
        InstanceEdits later;
        later[{name, number_of(instance, instances)}] = read_edit(instance);
        add(edits, later);
    }
}

// The mesh without triangles that is shown in place of what is not seen.
uint32_t nothing_in(Scene& scene) {
    const auto found =
        std::ranges::find_if(scene.meshes, [](const TriangleMesh& mesh) { return mesh.positions.empty(); });
    if (found == scene.meshes.end()) {
        scene.meshes.emplace_back();
        return uint32_t(scene.meshes.size() - 1);
    }
    return uint32_t(found - scene.meshes.begin());
}

// The shape as the edit has it, were it visible.
Shape edited(const InstanceEdit& edit, const std::string& place, const Shape& before, const Scene& scene) {
    Shape shape = before;
    const std::string object = "the object " + quote(scene.objects[before.object]);
    const auto* const mesh = std::get_if<MeshInstance>(&before.geometry);
    if (mesh != nullptr && !scene.meshes[mesh->mesh].groups.empty())
        throw Error(place + ": " + object +
                    " shares a mesh with others of its file; move them apart in the file, and load it again");
    Origin origin = origin_of(before);
    const double scale = origin.transform.mean_scale();
    if (edit.transform) origin.transform = *edit.transform;
    const std::optional<BumpMap>& bump = scene.materials[before.material].bump_map;
    if (bump && bump->multiplier && origin.transform.mean_scale() != scale)
        throw Error(
            place + ": " + object +
            " has heights in the units of its file, which depend on its scale; change the scene's file, "
            "and load it again");
    shape.visible = edit.visible.value_or(before.visible);
    if (!place_object(shape, origin.geometry, origin.transform))
        throw Error(place + ": " + object +
                    " cannot be placed so: the transform flattens it, or scales a sphere in it unevenly; use "
                    "other factors");
    if (!reaches_no_farther(scene, shape.geometry)) throw Error(place + ": " + object + ": " + TOO_FAR);
    if (!shape.visible) shape.origin = std::make_shared<const Origin>(origin);
    return shape;
}

}  // namespace

InstanceEdits read_object_changes(const Node& objects, const Scene& scene) {
    const auto instances = instances_of(scene);
    std::vector<std::string> names;
    for (const auto& [name, numbers] : instances)
        names.push_back(name);
    InstanceEdits edits;
    for (const Node& node : objects.members()) {
        const auto found = instances.find(std::string(node.key()));
        if (found == instances.end()) node.fail_unknown("object", node.key(), names, "defined");
        read_object(node, found->second, edits);
    }
    return edits;
}

void add(InstanceEdits& edits, const InstanceEdits& later) {
    for (const auto& [instance, edit] : later) {
        InstanceEdit& known = edits[instance];
        if (edit.transform) known.transform = edit.transform;
        if (edit.visible) known.visible = edit.visible;
    }
}

std::vector<MovedShape> move_shapes(const InstanceEdits& edits, const std::string& name, Scene& scene) {
    std::vector<MovedShape> moved;
    if (edits.empty()) return moved;
    std::optional<uint32_t> nothing;
    for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        if (shape.object == NO_OBJECT) continue;
        const auto found = edits.find({scene.objects[shape.object], shape.copy});
        if (found == edits.end() || found->second == InstanceEdit()) continue;
        moved.push_back({i, edited(found->second, name, shape, scene)});
        if (moved.back().moved.visible) continue;
        if (!nothing) nothing = nothing_in(scene);
        moved.back().moved.geometry = MeshInstance{*nothing, Transform()};
    }
    return moved;
}

void take_shapes(std::vector<MovedShape> shapes, Scene& scene, SceneChange& change) {
    for (MovedShape& made : shapes) {
        Shape& shape = scene.shapes[made.shape];
        const Shape before = shape;
        shape.geometry = made.moved.geometry;
        shape.origin = std::move(made.moved.origin);
        shape.visible = made.moved.visible;
        note_shape(change, made.shape, before, shape);
    }
}

}  // namespace candela
