// See objects.h.
#include "load/json/objects.h"

#include <optional>
#include <utility>
#include <variant>

#include "load/json/arrays.h"
#include "load/json/keys.h"
#include "scene/place.h"

namespace candela {
namespace {

// The transforms of an instance: its list, or its only one.
std::vector<std::pair<Node, Transform>> transforms_of(const Node& node, const Scene& scene) {
    std::vector<std::pair<Node, Transform>> transforms;
    if (const auto list = node.find("transforms")) {
        if (const auto one = node.find("transform"))
            one->fail("an instance has either transform or transforms; put this one into the list");
        if (is_array_name(*list)) {
            for (const Transform& transform : read_transforms(*list, scene))
                transforms.emplace_back(*list, transform);
            return transforms;
        }
        for (const Node& transform : list->elements())
            transforms.emplace_back(transform, read_transform(transform));
        return transforms;
    }
    transforms.emplace_back(node, ShapeList::transform_of(node));
    return transforms;
}

}  // namespace

void read_instance(const Node& node, const ObjectMap& objects, ShapeList& shapes) {
    node.allow_only({"type"}, keys_of({"instance", "shape"}));
    const Node name = node.require("object");
    const auto object = objects.find(name.string());
    if (object == objects.end()) {
        std::vector<std::string> names;
        for (const auto& [known, its_shapes] : objects)
            names.push_back(known);
        name.fail_unknown("object", name.string(), names, "defined");
    }
    std::vector<Shape> shown = object->second;
    for (Shape& shape : shown) {
        const Appearance appearance = shapes.appearance_of(node, shape);
        shape.material = appearance.material;
        shape.emission = appearance.emission;
        shape.states_emission = appearance.states_emission;
        shape.beam = appearance.beam;
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance != nullptr && (node.find("material") || node.find("emission")))
            shapes.complete_mesh(node.place(), appearance, instance->mesh);
    }
    for (const auto& placement : transforms_of(node, shapes.scene())) {
        const Node& place_of = placement.first;
        const Transform& transform = placement.second;
        for (Shape shape : shown) {
            const Geometry own = shape.geometry;
            if (!place_object(shape, own, transform)) {
                place_of.fail(
                    "the transform flattens the object, or scales a sphere in it unevenly; use other "
                    "factors, or a mesh instead of the sphere");
            }
            if (!shapes.add_placed(shape)) place_of.fail(TOO_FAR);
        }
        shapes.begin_copy();
    }
}

}  // namespace candela
