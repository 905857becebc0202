// See scene_builders.h.
#include "support/scene_builders.h"

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <glm/packing.hpp>

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

void add_slab(Scene& scene, const DielectricMaterial& glass, float thickness) {
    constexpr float REACH = 100.0f;
    const uint32_t material = add_material(scene, glass);
    const vec3 lo(-REACH, -thickness, -REACH), hi(REACH, 0, REACH);
    const vec3 e = hi - lo;
    const vec3 x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
    add_shape(scene, parallelogram(lo, x, z), material);
    add_shape(scene, parallelogram(lo, y, x), material);
    add_shape(scene, parallelogram(lo, z, y), material);
    add_shape(scene, parallelogram(hi, -z, -x), material);
    add_shape(scene, parallelogram(hi, -x, -y), material);
    add_shape(scene, parallelogram(hi, -y, -z), material);
}

TriangleMesh in_its_frame(const TriangleMesh& mesh, double scale, dvec3 shift) {
    std::vector<dvec3> positions;
    for (const vec3 p : mesh.positions)
        positions.push_back(scale * (dvec3(p) + shift));
    TriangleMesh world{.triangles = mesh.triangles};
    set_positions(world, std::move(positions));
    return placed(world, Transform(), choose_frame(scene_of_mesh(world)));
}

Texture add_texture(Scene& scene, uvec2 size, const std::function<vec4(uint32_t, uint32_t)>& texel) {
    TexelImage image{.size = size, .channels = 4, .type = TexelType::half, .texels = {}, .gamma = {}};
    for (uint32_t y = 0; y < size.y; ++y) {
        for (uint32_t x = 0; x < size.x; ++x) {
            const vec4 value = texel(x, y);
            const std::array<uint32_t, 2> halves{glm::packHalf2x16(vec2(value.x, value.y)),
                                                 glm::packHalf2x16(vec2(value.z, value.w))};
            const auto bytes = std::as_bytes(std::span(halves));
            image.texels.insert(image.texels.end(), bytes.begin(), bytes.end());
        }
    }
    scene.images.push_back({.path = {}, .image = std::make_shared<TexelImage>(std::move(image))});
    return {.image = uint32_t(scene.images.size() - 1)};
}

Scene textured_scene() {
    Scene scene = open_room();
    const Texture checks = add_texture(scene, {4, 4}, [](uint32_t x, uint32_t y) {
        return (x + y) % 2 == 0 ? vec4(0.9f, 0.6f, 0.2f, 1.0f) : vec4(0.1f, 0.3f, 0.8f, 0.0f);
    });
    const Texture waves = add_texture(scene, {8, 4}, [](uint32_t x, uint32_t y) {
        const vec3 n = normalize(vec3(std::sin(float(x)), std::cos(float(y)), 1.0f));
        return vec4(0.5f * n + 0.5f, 0.25f + 0.5f * float(x % 2));
    });
    const auto textured = [](const Texture& texture) { return Textured<vec3>(vec3(1), texture); };
    const uint32_t floor = add_material(scene, DiffuseMaterial{textured(checks)});
    const uint32_t bumpy = add_material(scene, PhongMaterial{textured(checks), vec3(0.1f), 20.0f});
    scene.materials[bumpy].normal_map = NormalMap{waves, 0.7f};
    const uint32_t metal = add_material(scene, ConductorMaterial{vec3(0.9f), {0.8f, waves}});
    const uint32_t leaf =
        add_material(scene, DiffuseTransmissionMaterial{vec3(0.3f), {vec3(0.4f), checks}, {}});
    scene.materials[leaf].opacity.value = {1.0f, checks};
    scene.materials[leaf].opacity.value.texture->channel = 3;
    scene.materials[leaf].opacity.cutoff = 0.5f;
    const uint32_t veil = add_diffuse(scene, vec3(0.7f));
    scene.materials[veil].opacity.value = {0.9f, waves};
    const uint32_t painted = add_diffuse(scene, vec3(0.8f));
    scene.materials[painted].vertex_colors = true;
    const uint32_t black = add_diffuse(scene, vec3(0));

    add_shape(scene, parallelogram(vec3(-1, 0.01f, 1), vec3(2, 0, 0), vec3(0, 0, -2)), floor);
    add_shape(scene, Sphere{dvec3(-0.5, 0.35, 0.2), 0.3}, bumpy);
    add_shape(scene, Sphere{dvec3(0.45, 0.3, 0.3), 0.25}, metal);
    add_shape(scene, Sphere{dvec3(0.1, 0.8, -0.3), 0.25}, veil);
    add_shape(scene, Disk{dvec3(-0.2, 0.5, 0.6), dvec3(0.3, 0, 0.1), dvec3(0, 0.3, 0)}, leaf);
    TriangleMesh mesh = sphere_mesh(6, 8);
    for (vec3& p : mesh.positions) {
        mesh.uv0.emplace_back(p.x, p.y);
        mesh.colors.emplace_back(0.5f * p + 0.5f, 1.0f);
        p = vec3(0.6f, 0.7f, -0.4f) + 0.2f * p;
    }
    add_shape(scene, mesh, painted);
    for (vec3& p : mesh.positions)
        p -= vec3(1.1f, -0.3f, 0);
    add_shape(scene, mesh, veil, Emission{{vec3(2), checks}, false});

    // Lights of all kinds.
    add_shape(scene, parallelogram(vec3(-0.4f, 1.9f, -0.4f), vec3(0.8f, 0, 0), vec3(0, 0, 0.8f)), black,
              Emission{{vec3(6), checks}, true});
    add_shape(scene, Sphere{dvec3(-0.7, 1.4, 0.5), 0.2}, leaf, Emission{{vec3(5), checks}, false});
    add_shape(scene, Disk{dvec3(0.8, 1.2, 0.5), dvec3(0, 0, 0.3), dvec3(0, 0.3, 0)}, veil,
              Emission{{vec3(8), checks}, true});
    return scene;
}

Scene layered_scene() {
    Scene scene = open_room();
    const Texture waves = add_texture(scene, {8, 4}, [](uint32_t x, uint32_t y) {
        const vec3 n = normalize(vec3(std::sin(float(x)), std::cos(float(y)), 1.0f));
        return vec4(0.5f * n + 0.5f, 0.25f + 0.5f * float(x % 2));
    });
    const auto channel = [&](uint32_t c) {
        Texture texture = waves;
        texture.channel = c;
        return Textured<float>(1.0f, texture);
    };
    const vec3 orange(0.9f, 0.6f, 0.3f);
    const auto add = [&](const PrincipledMaterial& m) { return add_material(scene, m); };
    const uint32_t metal = add({.base_color = {orange, waves},
                                .metalness = channel(0),
                                .roughness = channel(3),
                                .anisotropy = 0.7f,
                                .anisotropy_rotation = 0.5f,
                                .anisotropy_map = waves});
    const uint32_t coated = add({.base_color = vec3(0.2f, 0.4f, 0.8f),
                                 .roughness = 0.6f,
                                 .diffuse_roughness = 0.6f,
                                 .coat = 0.8f,
                                 .coat_roughness = 0.3f,
                                 .coat_darkening = 0.5f,
                                 .coat_normal_map = NormalMap{waves, 0.4f},
                                 .iridescence = 0.5f});
    const uint32_t cloth = add({.base_color = orange,
                                .roughness = 0.9f,
                                .sheen_color = vec3(0.8f, 0.5f, 0.6f),
                                .sheen_roughness = channel(1),
                                .fuzz = 0.6f,
                                .fuzz_color = {orange, waves},
                                .fuzz_roughness = channel(1)});
    const uint32_t glass = add({.base_color = vec3(0.9f, 1.0f, 0.9f),
                                .roughness = 0.5f,
                                .specular = 0.7f,
                                .transmission = 0.8f,
                                .inside = Medium{vec3(1, 0.5f, 2)},
                                .dispersion = 1.0f,
                                .diffuse_transmission = 0.5f});
    const uint32_t wall = add({.roughness = 0.4f,
                               .transmission = 0.5f,
                               .diffuse_transmission = 0.5f,
                               .diffuse_transmission_color = orange});
    const uint32_t lamp = add({.base_color = orange, .coat = 1.0f, .coat_roughness = 0.5f});
    const uint32_t velvet_lamp = add({.sheen_color = vec3(0.9f, 0.2f, 0.5f),
                                      .sheen_roughness = 0.5f,
                                      .fuzz = 0.5f,
                                      .fuzz_roughness = 0.8f});

    add_shape(scene, Sphere{dvec3(-0.5, 0.35, 0.2), 0.3}, metal);
    add_shape(scene, Sphere{dvec3(0.45, 0.3, 0.3), 0.25}, glass);
    add_shape(scene, Sphere{dvec3(0.1, 0.8, -0.3), 0.25}, coated);
    add_shape(scene, Sphere{dvec3(0.6, 0.9, -0.4), 0.25}, cloth);
    add_shape(scene, Disk{dvec3(-0.3, 0.5, 0.65), dvec3(0.3, 0, 0.1), dvec3(0, 0.3, 0)}, wall);
    add_shape(scene, parallelogram(vec3(-0.4f, 1.9f, -0.4f), vec3(0.8f, 0, 0), vec3(0, 0, 0.8f)), lamp,
              Emission{vec3(6), true});
    add_shape(scene, Sphere{dvec3(-0.7, 1.4, 0.5), 0.2}, velvet_lamp, Emission{vec3(5), false});
    return scene;
}

Scene hazy_room() {
    Scene scene = open_room();
    scene.medium = {vec3(0.05f), vec3(0.05f, 0.1f, 0.15f), 0.5f};
    scene.environment = constant_environment(vec3(0.5f, 0.7f, 1.0f));
    const uint32_t black = add_diffuse(scene, vec3(0));
    add_shape(scene, Sphere{dvec3(-0.6, 0.5, 0), 0.4},
              add_material(scene, InterfaceMaterial{{vec3(0.2f), vec3(0.4f, 0.6f, 0.8f), -0.3f}}));
    add_shape(scene, Sphere{dvec3(-0.6, 0.5, 0), 0.2}, black, Emission{vec3(2, 4, 6)});
    add_shape(
        scene, Sphere{dvec3(0.5, 0.4, 0.2), 0.3},
        add_material(scene, DiffuseTransmissionMaterial{vec3(0.3f), vec3(0.6f), Medium{vec3(0), vec3(2)}}));
    add_shape(scene, parallelogram(vec3(-0.8f, 1.8f, -0.8f), vec3(1.6f, 0, 0), vec3(0, 0, 1.6f)), black,
              Emission{vec3(2, 4, 6)});
    scene.lights = {{"", PointLight{dvec3(0.9, 1, 0.5), vec3(0.3f)}}};
    return scene;
}

}  // namespace candela
