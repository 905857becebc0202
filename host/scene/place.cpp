// See place.h.
#include "scene/place.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "scene/scene_builder.h"

namespace candela {
namespace {

bool place_one(MeshInstance& instance, const Transform& transform) {
    if (instance.transform == Transform()) {
        instance.transform = transform;
        return true;
    }
    return instance.transform.append(transform.matrix());
}

bool place_one(Quad& quad, const Transform& transform) {
    for (dvec3& corner : quad.corners)
        corner = transform.point(corner);
    if (transform.mirrors()) {
        std::swap(quad.corners[1], quad.corners[3]);
        std::swap(quad.uvs[1], quad.uvs[3]);
    }
    return true;
}

bool place_one(Sphere& sphere, const Transform& transform) {
    const std::optional<double> scale = transform.uniform_scale();
    if (!scale) return false;
    sphere = {transform.point(sphere.center), *scale * sphere.radius, transform.vector(sphere.axis)};
    return true;
}

bool place_one(Disk& disk, const Transform& transform) {
    disk.center = transform.point(disk.center);
    disk.e1 = transform.vector(disk.e1);
    disk.e2 = transform.vector(disk.e2);
    if (transform.mirrors()) {
        std::swap(disk.e1, disk.e2);
        std::swap(disk.uvs[1], disk.uvs[2]);
    }
    return true;
}

bool fits(const Scene& scene, const MeshInstance& instance) {
    return reaches_no_farther(scene.meshes[instance.mesh], instance.transform);
}

bool fits(const Scene&, const Quad& quad) {
    return std::ranges::all_of(quad.corners, [](dvec3 corner) { return is_within_reach(corner); });
}

bool fits(const Scene&, const Sphere& sphere) {
    return is_within_reach(abs(sphere.center) + sphere.radius);
}

bool fits(const Scene&, const Disk& disk) {
    return is_within_reach(abs(disk.center) + abs(disk.e1) + abs(disk.e2));
}

}  // namespace

bool place(Geometry& geometry, const Transform& transform) {
    return std::visit([&](auto& one) { return place_one(one, transform); }, geometry);
}

Origin origin_of(const Shape& shape) {
    if (shape.origin) return *shape.origin;
    const auto* const instance = std::get_if<MeshInstance>(&shape.geometry);
    if (instance == nullptr) return {shape.geometry, Transform()};
    return {MeshInstance{instance->mesh, Transform()}, instance->transform};
}

bool place_object(Shape& shape, const Geometry& own, const Transform& transform) {
    shape.geometry = own;
    if (!place(shape.geometry, transform)) return false;
    // Then origin_of() knows.
    const auto* const instance = std::get_if<MeshInstance>(&own);
    const bool is_plain = instance != nullptr ? instance->transform == Transform() : transform == Transform();
    shape.origin = is_plain ? nullptr : std::make_shared<const Origin>(Origin{own, transform});
    return true;
}

bool reaches_no_farther(const Scene& scene, const Geometry& geometry) {
    return std::visit([&](const auto& one) { return fits(scene, one); }, geometry);
}

}  // namespace candela
