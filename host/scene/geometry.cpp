// Bounds and counts over the shapes of a scene.
#include "scene/geometry.h"

#include <algorithm>
#include <cmath>

#include "scene/materials.h"

namespace candela {
namespace {

void extend(DoubleBox& box, const Scene& scene, const MeshInstance& instance) {
    const TriangleMesh& mesh = scene.meshes[instance.mesh];
    for (const uvec3 t : mesh.triangles) {
        for (glm::length_t i = 0; i < 3; ++i)
            box.extend(instance.transform.point(mesh.origin + dvec3(mesh.positions[t[i]])));
    }
}

void extend(DoubleBox& box, const Scene&, const Quad& quad) {
    for (const dvec3 corner : quad.corners)
        box.extend(corner);
}

void extend(DoubleBox& box, const Scene&, const Sphere& sphere) {
    box.extend(sphere.center - sphere.radius);
    box.extend(sphere.center + sphere.radius);
}

// Along an axis, x e1 + y e2 is greatest where (x, y) is parallel to the components of e1 and e2 along it.
void extend(DoubleBox& box, const Scene&, const Disk& disk) {
    dvec3 reach;
    for (glm::length_t axis = 0; axis < 3; ++axis)
        reach[axis] = std::hypot(disk.e1[axis], disk.e2[axis]);
    box.extend(disk.center - reach);
    box.extend(disk.center + reach);
}

uint64_t triangles_of(const Scene& scene, const MeshInstance& instance) {
    return scene.meshes[instance.mesh].triangles.size();
}

uint64_t triangles_of(const Scene&, const Quad&) {
    return 2;
}

uint64_t triangles_of(const Scene&, const Sphere&) {
    return 0;
}

uint64_t triangles_of(const Scene&, const Disk&) {
    return 0;
}

vec3 brightness(const DirectionalLight& light) {
    return light.irradiance;
}

// The position of a point or spot light.
template <class Model>
vec3 brightness(const Model& light) {
    return light.intensity;
}

}  // namespace

ShapeBounds::ShapeBounds(const Scene& scene) : scene_(scene), mesh_boxes_(scene.meshes.size()) {
    constexpr uint64_t MANY_TRIANGLES = 1u << 22u;  // Limit for all copies: a fraction of a second.
    std::vector<uint64_t> uses(scene.meshes.size());
    uint64_t copied = 0;
    for (const Shape& shape : scene.shapes) {
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance != nullptr && ++uses[instance->mesh] > 1) copied += triangles_of(scene, *instance);
    }
    if (copied < MANY_TRIANGLES) return;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const TriangleMesh& mesh = scene.meshes[i];
        if (uses[i] < 2) continue;
        mesh_boxes_[i].emplace();
        for (const uvec3 t : mesh.triangles) {
            for (glm::length_t k = 0; k < 3; ++k)
                mesh_boxes_[i]->extend(mesh.origin + dvec3(mesh.positions[t[k]]));
        }
    }
}

DoubleBox ShapeBounds::operator()(const Shape& shape) const {
    DoubleBox box;
    const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
    if (instance == nullptr || !mesh_boxes_[instance->mesh]) {
        std::visit([&](const auto& geometry) { extend(box, scene_, geometry); }, shape.geometry);
        return box;
    }
    const DoubleBox& mesh = *mesh_boxes_[instance->mesh];
    for (int corner = 0; corner < 8; ++corner) {
        const auto side = [&](glm::length_t axis) {
            return ((corner >> axis) & 1) != 0 ? mesh.hi[axis] : mesh.lo[axis];
        };
        box.extend(instance->transform.point({side(0), side(1), side(2)}));
    }
    return box;
}

DoubleBox bounds(const Scene& scene) {
    const ShapeBounds bounds_of(scene);
    DoubleBox box;
    if (scene.motion) {
        box = scene.motion->still;
        for (const dvec3 p : scene.motion->ways)
            box.extend(p);
    }
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        if (!scene.motion || !scene.motion->covers(i)) box.extend(bounds_of(scene.shapes[i]));
    }
    return box;
}

uint64_t triangle_count(const Scene& scene) {
    uint64_t count = 0;
    for (const Shape& shape : scene.shapes) {
        count +=
            std::visit([&](const auto& geometry) { return triangles_of(scene, geometry); }, shape.geometry);
    }
    return count;
}

size_t emitter_count(const Scene& scene) {
    return size_t(std::count_if(scene.shapes.begin(), scene.shapes.end(),
                                [](const Shape& shape) { return shape.emission.has_value(); }));
}

bool gives_light(const Environment& environment) {
    return std::any_of(environment.radiance.begin(), environment.radiance.end(),
                       [](vec3 radiance) { return radiance != vec3(0.0f); });
}

bool gives_light(const Light& light) {
    return std::visit([](const auto& model) { return brightness(model) != vec3(0.0f); }, light.model);
}

bool has_light(const Scene& scene) {
    const auto needs_no_light = [&](const Shape& shape) { return is_unlit(scene.materials[shape.material]); };
    return emitter_count(scene) > 0 || (scene.environment && gives_light(*scene.environment)) ||
           std::ranges::any_of(scene.lights, [](const Light& light) { return gives_light(light); }) ||
           std::ranges::any_of(scene.shapes, needs_no_light);
}

}  // namespace candela
