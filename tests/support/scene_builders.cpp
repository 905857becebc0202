// See scene_builders.h.
#include "support/scene_builders.h"

#include <utility>

#include "gpu_scene/gpu_scene.h"
#include "scene/mesh.h"

namespace candela {

Scene floor_seen_closely(vec3 reflectance) {
    constexpr float FIELD_OF_VIEW = 1e-3f;
    Scene scene = scene_with_camera(dvec3(0, 1, 5), dvec3(0), FIELD_OF_VIEW);
    add_diffuse(scene, reflectance);
    add_diffuse(scene, vec3(0));
    add_shape(scene, parallelogram(vec3(-50, 0, 50), vec3(100, 0, 0), vec3(0, 0, -100)), 0);
    return scene;
}

TriangleMesh in_its_frame(const TriangleMesh& mesh, double scale, dvec3 shift) {
    std::vector<dvec3> positions;
    for (const vec3 p : mesh.positions)
        positions.push_back(scale * (dvec3(p) + shift));
    TriangleMesh world{.triangles = mesh.triangles};
    set_positions(world, std::move(positions));
    return placed(world, Transform(), choose_frame(scene_of_mesh(world)));
}

}  // namespace candela
