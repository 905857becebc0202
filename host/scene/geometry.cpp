// Sums over the shapes of a scene.
#include "scene/geometry.h"

#include <algorithm>

namespace candela {
namespace {

void extend(Box& box, const TriangleMesh& mesh) {
    for (const uvec3 t : mesh.triangles) {
        box.extend(mesh.positions[t.x]);
        box.extend(mesh.positions[t.y]);
        box.extend(mesh.positions[t.z]);
    }
}

void extend(Box& box, const Quad& quad) {
    for (const vec3 corner : quad.corners)
        box.extend(corner);
}

uint64_t triangles_of(const TriangleMesh& mesh) {
    return mesh.triangles.size();
}

uint64_t triangles_of(const Quad&) {
    return 2;
}

}  // namespace

Box bounds(const Scene& scene) {
    Box box;
    for (const Shape& shape : scene.shapes) {
        std::visit([&](const auto& geometry) { extend(box, geometry); }, shape.geometry);
    }
    return box;
}

uint64_t triangle_count(const Scene& scene) {
    uint64_t count = 0;
    for (const Shape& shape : scene.shapes) {
        count += std::visit([](const auto& geometry) { return triangles_of(geometry); }, shape.geometry);
    }
    return count;
}

size_t emitter_count(const Scene& scene) {
    return size_t(std::count_if(scene.shapes.begin(), scene.shapes.end(),
                                [](const Shape& shape) { return shape.emission.has_value(); }));
}

}  // namespace candela
