// See scene_builders.h.
#include "support/scene_builders.h"

#include <cmath>

#include "scene/loader.h"
#include "support/reference_random.h"

namespace candela {

Scene cornell_box() {
    return load_scene(CANDELA_SCENES "/cornell-box.json");
}

Scene furnace(float albedo) {
    Scene scene = load_scene(CANDELA_SCENES "/furnace.json");
    for (Material& material : scene.materials)
        material.model = DiffuseMaterial{vec3(albedo)};
    return scene;
}

uint32_t add_diffuse(Scene& scene, vec3 reflectance) {
    scene.materials.push_back({.name = "", .model = DiffuseMaterial{reflectance}});
    return uint32_t(scene.materials.size() - 1);
}

Quad parallelogram(vec3 p, vec3 e1, vec3 e2) {
    return {{p, p + e1, p + e1 + e2, p + e2}};
}

Scene scene_with_camera(vec3 position, vec3 look_at, float vertical_fov) {
    Scene scene;
    const vec3 up = std::abs(normalize(look_at - position).y) < 0.9f ? vec3(0, 1, 0) : vec3(0, 0, 1);
    scene.cameras.push_back(
        {.name = "main", .position = position, .look_at = look_at, .up = up, .vertical_fov = vertical_fov});
    return scene;
}

TriangleMesh sphere_mesh(uint32_t rings, uint32_t segments) {
    TriangleMesh mesh;
    mesh.positions.emplace_back(0, 1, 0);
    for (uint32_t ring = 1; ring < rings; ++ring) {
        const float theta = PI * float(ring) / float(rings);
        for (uint32_t s = 0; s < segments; ++s) {
            const float phi = 2.0f * PI * float(s) / float(segments);
            mesh.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                        -std::sin(theta) * std::sin(phi));
        }
    }
    mesh.positions.emplace_back(0, -1, 0);

    const auto last = uint32_t(mesh.positions.size() - 1);
    const auto at = [&](uint32_t ring, uint32_t s) {
        return ring == 0 ? 0 : ring == rings ? last : 1 + (ring - 1) * segments + s % segments;
    };
    for (uint32_t ring = 0; ring < rings; ++ring) {
        for (uint32_t s = 0; s < segments; ++s) {
            const uint32_t a = at(ring, s), b = at(ring + 1, s), c = at(ring + 1, s + 1), d = at(ring, s + 1);
            if (b != c) mesh.triangles.emplace_back(a, b, c);
            if (a != d) mesh.triangles.emplace_back(a, c, d);
        }
    }
    return mesh;
}

TriangleMesh triangle_soup(uint32_t count, float size, uint32_t seed) {
    Random random(seed);
    TriangleMesh mesh;
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 centre = random.cube();
        for (int corner = 0; corner < 3; ++corner)
            mesh.positions.push_back(centre + size * random.cube());
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return mesh;
}

TriangleMesh transformed(TriangleMesh mesh, const std::function<vec3(vec3)>& f) {
    for (vec3& p : mesh.positions)
        p = f(p);
    return mesh;
}

Scene scene_of_mesh(TriangleMesh mesh) {
    Scene scene = scene_with_camera(vec3(0), vec3(0, 0, -1), 1.0f);
    add_diffuse(scene, vec3(0.5f));
    scene.shapes.push_back({.geometry = std::move(mesh), .material = 0, .emission = std::nullopt});
    return scene;
}

}  // namespace candela
