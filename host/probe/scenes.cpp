// See scenes.h.
#include "probe/scenes.h"

#include <cmath>

#include "load/json/loader.h"
#include "probe/embedded.h"
#include "probe/random.h"

namespace candela {

Scene cornell_box() {
    return parse_scene(embedded::cornell_box_json, "cornell-box.json");
}

Scene furnace(float albedo) {
    Scene scene = parse_scene(embedded::furnace_json, "furnace.json");
    for (Material& material : scene.materials)
        material.model = DiffuseMaterial{vec3(albedo)};
    return scene;
}

uint32_t add_material(Scene& scene, const decltype(Material::model)& model) {
    scene.materials.push_back({.name = "", .model = model});
    return uint32_t(scene.materials.size() - 1);
}

uint32_t add_diffuse(Scene& scene, vec3 reflectance) {
    return add_material(scene, DiffuseMaterial{reflectance});
}

void add_shape(Scene& scene, const decltype(Shape::geometry)& geometry, uint32_t material,
               std::optional<Emission> emission) {
    scene.shapes.push_back({.geometry = geometry, .material = material, .emission = emission});
}

void add_shape(Scene& scene, TriangleMesh mesh, uint32_t material, std::optional<Emission> emission) {
    add_shape(scene, MeshInstance{uint32_t(scene.meshes.size())}, material, emission);
    scene.meshes.push_back(std::move(mesh));
}

Environment constant_environment(vec3 radiance) {
    return {.size = {1, 1}, .radiance = {radiance}};
}

Environment one_bright_texel(uvec2 size, uvec2 texel, vec3 radiance) {
    Environment environment{.size = size, .radiance = std::vector<vec3>(size_t(size.x) * size.y)};
    environment.radiance[size_t(texel.y) * size.x + texel.x] = radiance;
    return environment;
}

Quad parallelogram(dvec3 p, dvec3 e1, dvec3 e2) {
    return {{p, p + e1, p + e1 + e2, p + e2}};
}

Quad parallelogram(vec3 p, vec3 e1, vec3 e2) {
    return {{dvec3(p), dvec3(p + e1), dvec3(p + e1 + e2), dvec3(p + e2)}};
}

Scene scene_with_camera(dvec3 position, dvec3 look_at, float vertical_fov) {
    Scene scene;
    const vec3 up = std::abs(normalize(look_at - position).y) < 0.9 ? vec3(0, 1, 0) : vec3(0, 0, 1);
    scene.cameras.push_back({.name = "main",
                             .position = position,
                             .look_at = look_at,
                             .up = up,
                             .vertical_fov = vertical_fov,
                             .lens = {}});
    return scene;
}

Scene open_room() {
    Scene scene = scene_with_camera(dvec3(0, 1, 2.9), dvec3(0, 0.9, 0), 1.0f);
    const uint32_t wall = add_diffuse(scene, vec3(0.5f, 0.6f, 0.7f));
    add_shape(scene, parallelogram(vec3(-2, 0, 2), vec3(4, 0, 0), vec3(0, 0, -4)), wall);  // Floor.
    add_shape(scene, parallelogram(vec3(-2, 0, -2), vec3(4, 0, 0), vec3(0, 2, 0)), wall);  // Back wall.
    add_shape(scene, parallelogram(vec3(-2, 2, -2), vec3(4, 0, 0), vec3(0, 0, 4)), wall);  // Ceiling.
    return scene;
}

Scene scene_of_everything() {
    Scene scene = open_room();
    scene.cameras[0].lens = {.radius = 0.05f, .focal_distance = 2.5f, .blades = 5, .rotation = 0.3f};
    scene.environment = one_bright_texel({8, 4}, {5, 1}, vec3(6, 5, 4));
    for (vec3& texel : scene.environment->radiance)
        texel += vec3(0.2f, 0.3f, 0.4f);
    scene.environment->rotation = 0.7f;

    const uint32_t black = add_diffuse(scene, vec3(0));
    const uint32_t phong = add_material(scene, PhongMaterial{vec3(0.3f), vec3(0.6f, 0.5f, 0.4f), 50.0f});
    const uint32_t mirror = add_material(scene, MirrorMaterial{vec3(0.9f)});
    const uint32_t metal = add_material(scene, ConductorMaterial{vec3(0.9f, 0.7f, 0.4f), 0.2f});
    const uint32_t glass = add_material(scene, DielectricMaterial{.inside = {vec3(0.5f, 1, 2)}});
    const uint32_t exact_glass =
        add_material(scene, DielectricMaterial{.ior = 1.8f, .fresnel = Fresnel::exact});
    const uint32_t leaf =
        add_material(scene, DiffuseTransmissionMaterial{vec3(0.2f, 0.4f, 0.1f), vec3(0.3f, 0.5f, 0.2f)});

    const vec3 bright(3, 2, 1);
    add_shape(scene, parallelogram(vec3(-1, 1.99f, -1), vec3(0.8f, 0, 0), vec3(0, 0, 0.8f)), black,
              Emission{bright, false});
    add_shape(scene, Sphere{dvec3(1.5, 1.6, -1), 0.2}, black, Emission{bright, false});
    add_shape(scene, Sphere{dvec3(-1.6, 1.2, 0), 0.15}, metal, Emission{bright, true});
    add_shape(scene, Disk{dvec3(0.6, 1.95, -0.5), dvec3(0.3, 0, 0), dvec3(0, 0, 0.2)}, phong,
              Emission{bright, true});

    add_shape(scene, Sphere{dvec3(-0.9, 0.5, -0.3), 0.4}, glass);
    add_shape(scene, Sphere{dvec3(-0.9, 0.5, -0.3), 0.1}, phong);  // Within the glass.
    add_shape(scene, Sphere{dvec3(0.1, 0.4, 0.4), 0.3}, exact_glass);
    add_shape(scene, Sphere{dvec3(0.9, 0.5, -0.8), 0.4}, mirror);
    add_shape(scene, Disk{dvec3(0, 0.9, -1.9), dvec3(0.6, 0, 0.1), dvec3(0, 0.6, 0)}, metal);
    TriangleMesh ball = sphere_mesh(8, 12);
    ball.normals = ball.positions;
    add_shape(scene, transformed(ball, [](vec3 p) { return vec3(0.9f, 0.3f, 0.5f) + 0.25f * p; }), phong);
    add_shape(scene, Disk{dvec3(-0.3, 1.1, 0.2), dvec3(0.3, 0.1, 0), dvec3(0, 0.1, 0.3)}, leaf);
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

void add_triangle(TriangleMesh& mesh, vec3 a, vec3 b, vec3 c) {
    const auto first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
}

TriangleMesh nasty_mesh(uint32_t count) {
    Random random(201);
    TriangleMesh mesh;
    for (uint32_t i = 0; i < count / 4; ++i) {
        const vec3 p = random.cube(), along = random.direction();
        add_triangle(mesh, p, p + along, p + along + 1e-6f * random.direction());
    }
    for (uint32_t plane = 0; plane < 20; ++plane) {
        const vec3 o = random.cube(), x = random.direction(), y = random.direction();
        const auto point = [&] {
            const vec2 place = 2.0f * random.square() - 1.0f;
            return o + place.x * x + place.y * y;
        };
        for (uint32_t i = 0; i < count / 4 / 20; ++i) {
            const vec3 a = point(), b = point();
            add_triangle(mesh, a, b, point());
        }
    }
    for (uint32_t i = 0; i < count / 4; ++i) {
        const float size = std::pow(10.0f, -3.0f + 6.0f * random.unit());
        const vec3 centre = size * random.cube();
        const vec3 a = centre + size * random.cube(), b = centre + size * random.cube();
        add_triangle(mesh, a, b, centre + size * random.cube());
    }
    for (uint32_t i = 0; i < count / 4; ++i) {
        const uvec3 t = mesh.triangles[size_t{3} * i];
        mesh.triangles.push_back(i % 2 == 0 ? t : uvec3(t.y, t.z, t.x));
    }
    return mesh;
}

TriangleMesh transformed(TriangleMesh mesh, const std::function<vec3(vec3)>& f) {
    for (vec3& p : mesh.positions)
        p = f(p);
    return mesh;
}

Scene scene_of_mesh(TriangleMesh mesh) {
    Scene scene = scene_with_camera(dvec3(0), dvec3(0, 0, -1), 1.0f);
    add_diffuse(scene, vec3(0.5f));
    add_shape(scene, std::move(mesh), 0);
    return scene;
}

}  // namespace candela
