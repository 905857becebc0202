// See objects.h.
#include "load/json/objects.h"

#include <optional>
#include <utility>
#include <variant>

#include "load/json/keys.h"

namespace candela {
namespace {

// Each places a geometry once more, by a transform from the geometry's space; returns false if that is not
// possible.
bool place(MeshInstance& instance, const Transform& transform) {
    return instance.transform.append(transform.matrix());
}

bool place(Quad& quad, const Transform& transform) {
    for (dvec3& corner : quad.corners)
        corner = transform.point(corner);
    if (transform.mirrors()) {
        std::swap(quad.corners[1], quad.corners[3]);
        std::swap(quad.uvs[1], quad.uvs[3]);
    }
    return true;
}

bool place(Sphere& sphere, const Transform& transform) {
    const std::optional<double> scale = transform.uniform_scale();
    if (!scale) return false;
    sphere = {transform.point(sphere.center), *scale * sphere.radius};
    return true;
}

bool place(Disk& disk, const Transform& transform) {
    disk.center = transform.point(disk.center);
    disk.e1 = transform.vector(disk.e1);
    disk.e2 = transform.vector(disk.e2);
    if (transform.mirrors()) {
        std::swap(disk.e1, disk.e2);
        std::swap(disk.uvs[1], disk.uvs[2]);
    }
    return true;
}

// The transforms of an instance: its list, or its only one.
std::vector<std::pair<Node, Transform>> transforms_of(const Node& node) {
    std::vector<std::pair<Node, Transform>> transforms;
    if (const auto list = node.find("transforms")) {
        if (const auto one = node.find("transform"))
            one->fail("an instance has either transform or transforms; put this one into the list");
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
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance != nullptr && (node.find("material") || node.find("emission")))
            shapes.complete_mesh(node.place(), appearance, instance->mesh);
    }
    for (const auto& placement : transforms_of(node)) {
        const Node& place_of = placement.first;
        const Transform& transform = placement.second;
        for (Shape shape : shown) {
            if (!std::visit([&](auto& geometry) { return place(geometry, transform); }, shape.geometry)) {
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
