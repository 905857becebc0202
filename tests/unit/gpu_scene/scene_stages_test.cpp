// A scene's records after a change are those of a fresh build, and what does not depend on the change is not
// made again: neither does it move, nor does it show what was spoilt in the scene behind the stages' back.
#include "gpu_scene/scene_stages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "render/make_identity.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

const InstancingRule RULE{.min_uses = 2, .min_triangles = 1};

Transform at(dvec3 place) {
    Transform transform;
    glm::dmat4 matrix(1.0);
    matrix[3] = glm::dvec4(place.x, place.y, place.z, 1.0);
    transform.append(matrix);
    return transform;
}

Environment sky(float brightness) {
    return {.size = {2, 2},
            .radiance = {brightness * vec3(1), brightness * vec3(2, 3, 4), vec3(0), brightness * vec3(5)},
            .rotation = 0.5f};
}

// Two instances of a mesh, one of another, whose copies are shapes 2 and 3; a mesh that is baked; a floor,
// and lamps of all kinds. The floor is the widest of them, and its texture is image 0.
struct World {
    enum : uint32_t { INSTANCE = 0, BAKED = 4, FLOOR = 5, LAMP = 6 };

    World() : scene(scene_with_camera(dvec3(0, 3, 9), dvec3(0), 1.0f)) {
        const Texture texture = add_texture(scene, {4, 4}, [](uint32_t x, uint32_t y) {
            return vec4(vec3(0.1f * float(x) + 0.05f * float(y)), 1.0f);
        });
        const uint32_t grey = add_diffuse(scene, vec3(0.5f));
        const uint32_t tiles = add_material(scene, DiffuseMaterial{{vec3(0.8f), texture}});
        scene.meshes = {sphere_mesh(6, 8), sphere_mesh(4, 6), sphere_mesh(5, 7)};
        for (const auto& [mesh, place] : {std::pair(0u, dvec3(-3, 1, 0)),
                                          {0u, dvec3(3, 1, 0)},
                                          {1u, dvec3(0, 1, 3)},
                                          {1u, dvec3(0, 1, -3)},
                                          {2u, dvec3(0, 2, 0)}})
            scene.shapes.push_back(
                {.geometry = MeshInstance{mesh, at(place)}, .material = grey, .emission = {}});
        add_shape(scene, Quad{{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}}, tiles);
        add_shape(scene, Quad{{{-1, 6, -1}, {1, 6, -1}, {1, 6, 1}, {-1, 6, 1}}}, grey,
                  Emission{vec3(5), false});
        add_shape(scene, Sphere{dvec3(5, 4, 0), 0.5}, grey, Emission{{vec3(2), texture}, false});
        scene.lights.push_back({"point", PointLight{dvec3(0, 4, 4), vec3(3)}});
        scene.environment = sky(1.0f);
    }

    Scene scene;
};

// Turns the triangles of a mesh around, which leaves its bounds alone.
void turn(TriangleMesh& mesh) {
    for (uvec3& t : mesh.triangles)
        std::swap(t.y, t.z);
}

BufferSet set_of(std::initializer_list<uint32_t> buffers) {
    BufferSet set;
    for (const uint32_t buffer : buffers)
        set.set(buffer);
    return set;
}

void expect_equal(const GpuScene& a, const GpuScene& b) {
    for (const SceneArray& array : SCENE_ARRAYS)
        EXPECT_TRUE(a.arrays[array.number] == b.arrays[array.number]) << array.name;
    EXPECT_EQ(a.frame, b.frame);
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_EQ(a.id_count, b.id_count);
    EXPECT_EQ(a.environment_rotation, b.environment_rotation);
    // And all that parameters and constants say.
    EXPECT_EQ(make_identity(a, Camera{}, {}).hash, make_identity(b, Camera{}, {}).hash);
}

// Builds stages, changes the scene, and spoils parts of it that no stage should look at again. Expects the
// records of a fresh build without the spoilt parts, and that only these buffers are others.
void expect_update(const std::function<void(Scene&)>& alter, const SceneChange& change,
                   const BufferSet& buffers, const std::function<void(Scene&)>& spoil) {
    World world;
    SceneStages stages(world.scene, {.rule = RULE});
    ASSERT_EQ(stages.joined().instances.size(), 4u);
    std::array<const uvec4*, ARRAY_COUNT> before;
    for (uint32_t i = 0; i < ARRAY_COUNT; ++i)
        before[i] = stages.joined().arrays[i].data();
    alter(world.scene);
    const GpuScene fresh = build_gpu_scene(world.scene, choose_frame(world.scene), RULE);
    spoil(world.scene);
    EXPECT_EQ(stages.update(world.scene, change), buffers);
    expect_equal(stages.joined(), fresh);
    for (const SceneArray& array : SCENE_ARRAYS) {
        const bool stays = stages.joined().arrays[array.number].data() == before[array.number];
        EXPECT_TRUE(stays || buffers[array.buffer]) << array.name;
    }
}

void spoil_meshes(Scene& scene) {
    for (TriangleMesh& mesh : scene.meshes)
        turn(mesh);
}

void spoil_materials(Scene& scene) {
    for (Material& material : scene.materials)
        material.model = MirrorMaterial{};
}

void spoil_sky(Scene& scene) {
    scene.environment->radiance[0] *= 7.0f;
}

void spoil_images(Scene& scene) {
    TexelImage black = *scene.images[0].image;
    std::ranges::fill(black.texels, std::byte{0});
    scene.images[0].image = std::make_shared<TexelImage>(std::move(black));
}

TEST(SceneStages, AnotherSkyRebuildsNeitherSceneNorTree) {
    const auto spoil = [](Scene& scene) {
        spoil_meshes(scene), spoil_materials(scene), spoil_images(scene);
        std::get<Quad>(scene.shapes[World::FLOOR].geometry).corners[0].y = 1.0;
    };
    expect_update([](Scene& scene) { scene.environment = sky(2.0f); }, {.environment = true},
                  set_of({BUFFER_ENVIRONMENT}), spoil);
    // Too dim to be chosen as often as the lamps.
    expect_update([](Scene& scene) { scene.environment = sky(1e-3f); }, {.environment = true},
                  set_of({BUFFER_ENVIRONMENT, BUFFER_LIGHTS}), spoil);
    // No light any more.
    for (const auto& environment : {std::optional<Environment>(), {constant_environment(vec3(1))}})
        expect_update([&](Scene& scene) { scene.environment = environment; }, {.environment = true},
                      set_of({BUFFER_ENVIRONMENT, BUFFER_LIGHTS}), spoil);
    expect_update([](Scene& scene) { scene.environment->rotation = 1.0f; }, {.rotation = true}, {},
                  [&](Scene& scene) { spoil(scene), spoil_sky(scene), scene.lights.clear(); });
}

TEST(SceneStages, AMovedInstanceRebuildsOnlyTheTreeAbove) {
    const auto spoil = [](Scene& scene) {
        spoil_meshes(scene), spoil_materials(scene), spoil_images(scene), spoil_sky(scene);
        scene.shapes[World::LAMP].emission->radiance.factor *= 3.0f;
    };
    const auto move_to = [](dvec3 place) {
        return [=](Scene& scene) {
            std::get<MeshInstance>(scene.shapes[World::INSTANCE].geometry).transform = at(place);
        };
    };
    expect_update(move_to(dvec3(-3.001, 1, 0)), {.moved = {World::INSTANCE}}, set_of({BUFFER_NODES}), spoil);
}

// Then the frame is another one, and with it all but the meshes in spaces of their own.
TEST(SceneStages, AnInstanceFarAwayChangesTheFrame) {
    expect_update(
        [](Scene& scene) {
            std::get<MeshInstance>(scene.shapes[World::INSTANCE].geometry).transform = at(dvec3(-30, 1, 0));
        },
        {.moved = {World::INSTANCE}},
        set_of({BUFFER_NODES, BUFFER_PRIMITIVES, BUFFER_SURFACES, BUFFER_LIGHTS}),
        [](Scene& scene) { turn(scene.meshes[0]), turn(scene.meshes[1]), spoil_sky(scene); });
}

TEST(SceneStages, AMovedSurfaceRebuildsSurfaces) {
    expect_update(
        [](Scene& scene) {
            std::get<MeshInstance>(scene.shapes[World::BAKED].geometry).transform = at(dvec3(1, 2, 1));
        },
        {.moved = {World::BAKED}},
        set_of({BUFFER_NODES, BUFFER_PRIMITIVES, BUFFER_SURFACES, BUFFER_ATTRIBUTES, BUFFER_LIGHTS}),
        [](Scene& scene) {
            turn(scene.meshes[0]), turn(scene.meshes[1]), spoil_materials(scene), spoil_sky(scene);
        });
}

TEST(SceneStages, AnotherMeshRebuildsItsTree) {
    const auto spoil = [](Scene& scene) { turn(scene.meshes[1]), turn(scene.meshes[2]), spoil_sky(scene); };
    expect_update([](Scene& scene) { turn(scene.meshes[0]); }, {.meshes = {0}}, set_of({BUFFER_PRIMITIVES}),
                  spoil);
    // Another number of triangles.
    expect_update([](Scene& scene) { scene.meshes[0] = sphere_mesh(7, 9); }, {.meshes = {0}},
                  set_of({BUFFER_NODES, BUFFER_PRIMITIVES, BUFFER_SURFACES, BUFFER_ATTRIBUTES}), spoil);
    // Normals: each primitive gets a record of them.
    expect_update([](Scene& scene) { scene.meshes[0].normals = scene.meshes[0].positions; }, {.meshes = {0}},
                  set_of({BUFFER_SURFACES, BUFFER_NORMALS}), spoil_sky);
}

TEST(SceneStages, MaterialsRebuildNoGeometry) {
    const auto spoil = [](Scene& scene) { spoil_meshes(scene), spoil_sky(scene); };
    const auto of_grey = [](const decltype(Material::model)& model) {
        return [=](Scene& scene) { scene.materials[0].model = model; };
    };
    expect_update(of_grey(DiffuseMaterial{vec3(0.25f)}), {.materials = true}, set_of({BUFFER_MATERIALS}),
                  spoil);
    expect_update(of_grey(ConductorMaterial{vec3(0.25f), 0.5f}), {.materials = true},
                  set_of({BUFFER_MATERIALS}), spoil);
    // Some rays pass what has it: all surfaces but the floor, and the lamps of quads have textures.
    expect_update([](Scene& scene) { scene.materials[0].opacity.value = 0.5f; }, {.materials = true},
                  set_of({BUFFER_MATERIALS, BUFFER_SURFACES}), spoil_sky);
    // Other attributes.
    expect_update([](Scene& scene) { scene.materials[0].vertex_colors = true; }, {.materials = true},
                  set_of({BUFFER_MATERIALS, BUFFER_ATTRIBUTES}), spoil_sky);
}

TEST(SceneStages, LampsRebuildLights) {
    const auto spoil = [](Scene& scene) { spoil_meshes(scene), spoil_materials(scene), spoil_sky(scene); };
    expect_update([](Scene& scene) { scene.shapes[World::LAMP].emission->radiance.factor *= 3.0f; },
                  {.radiance = true}, set_of({BUFFER_LIGHTS}), spoil);
    // Black: the light after it has another index.
    expect_update([](Scene& scene) { scene.shapes[World::LAMP].emission->radiance.factor = vec3(0); },
                  {.radiance = true}, set_of({BUFFER_LIGHTS, BUFFER_SURFACES}), spoil);
    expect_update([](Scene& scene) { std::get<PointLight>(scene.lights[0].model).position.x = 2.0; },
                  {.lights = true}, set_of({BUFFER_LIGHTS}),
                  [&](Scene& scene) { spoil(scene), spoil_images(scene); });
    // Another shape emits.
    expect_update(
        [](Scene& scene) {
            scene.shapes[World::FLOOR].emission = Emission{vec3(1), true};
        },
        {.shapes = {World::FLOOR}}, set_of({BUFFER_LIGHTS, BUFFER_SURFACES}),
        [](Scene& scene) { turn(scene.meshes[0]), turn(scene.meshes[1]), spoil_sky(scene); });
}

TEST(SceneStages, ImagesRebuildTexelsAndTheLightsThatLookThemUp) {
    expect_update(
        [](Scene& scene) {
            add_texture(scene, {4, 4},
                        [](uint32_t x, uint32_t) { return vec4(vec3(x == 2 ? 1.0f : 0.0f), 1.0f); });
            scene.images[0] = scene.images.back();
            scene.images.pop_back();
        },
        {.images = true}, set_of({BUFFER_TEXELS, BUFFER_LIGHTS}),
        [](Scene& scene) { spoil_meshes(scene), spoil_sky(scene); });
}

// Four copies of a mesh that emit alike.
struct LampWorld : World {
    enum : uint32_t { FIRST = 8, LAST = 11 };

    LampWorld() {
        for (uint32_t i = FIRST; i <= LAST; ++i)
            scene.shapes.push_back({.geometry = MeshInstance{2, at(dvec3(i, 3, 1))},
                                    .material = 0,
                                    .emission = Emission{vec3(1), false}});
    }
};

TEST(SceneStages, LampsAreThoseOfAFreshScene) {
    const auto glow = [](uint32_t first, vec3 radiance) {
        return [=](Scene& scene) {
            for (uint32_t i = first; i <= LampWorld::LAST; ++i)
                scene.shapes[i].emission->radiance.factor = radiance;
        };
    };
    const std::vector<std::pair<std::function<void(Scene&)>, SceneChange>> changes{
        {[](Scene& scene) {
             std::get<MeshInstance>(scene.shapes[LampWorld::FIRST].geometry).transform = at(dvec3(8, 3, 2));
         },
         {.moved = {LampWorld::FIRST}}},
        {glow(LampWorld::FIRST, vec3(2)), {.radiance = true}},
        {glow(LampWorld::LAST, vec3(3)), {.radiance = true}},      // It is baked then.
        {glow(LampWorld::LAST - 1, vec3(4)), {.radiance = true}},  // Two ways to glow.
        {glow(LampWorld::FIRST, vec3(0)), {.radiance = true}},     // All are black.
        {[](Scene& scene) { scene.shapes[World::LAMP].emission->radiance.factor = vec3(0); },
         {.radiance = true}},  // The lamps have other places.
        {[](Scene& scene) { scene.meshes[2] = sphere_mesh(3, 4); }, {.meshes = {2}}},
        {[](Scene& scene) { scene.shapes[LampWorld::FIRST].emission.reset(); },
         {.shapes = {LampWorld::FIRST}}},
        {[](Scene& scene) {
             for (uint32_t i = LampWorld::FIRST; i <= LampWorld::LAST; ++i)
                 scene.shapes[i].emission = scene.shapes[World::LAMP + 1].emission;
         },
         {.shapes = {8, 9, 10, 11}}},  // They glow in the colours of the image.
        {[](Scene& scene) {
             std::get<MeshInstance>(scene.shapes[LampWorld::FIRST].geometry).transform = at(dvec3(80, 3, 2));
         },
         {.moved = {LampWorld::FIRST}}},  // In another frame.
    };
    for (size_t i = 0; i < changes.size(); ++i) {
        SCOPED_TRACE(i);
        LampWorld world;
        SceneStages stages(world.scene, {.rule = RULE});
        ASSERT_EQ(stages.joined().instances.size(), 8u);
        changes[i].first(world.scene);
        stages.update(world.scene, changes[i].second);
        expect_equal(stages.joined(), build_gpu_scene(world.scene, choose_frame(world.scene), RULE));
    }
}

// A copy that is sheared too far has no tree of its own; one that emits otherwise than the others neither.
TEST(SceneStages, AnInstanceThatCannotBeOneIsBaked) {
    expect_update(
        [](Scene& scene) {
            Transform transform;
            glm::dmat4 shear(1.0);
            shear[1][0] = 1e3;
            transform.append(shear);
            std::get<MeshInstance>(scene.shapes[World::INSTANCE].geometry).transform = transform;
        },
        {.moved = {World::INSTANCE}},
        set_of({BUFFER_NODES, BUFFER_PRIMITIVES, BUFFER_SURFACES, BUFFER_ATTRIBUTES, BUFFER_LIGHTS}),
        spoil_sky);
    expect_update(
        [](Scene& scene) {
            scene.shapes[World::INSTANCE].emission = Emission{vec3(1), false};
        },
        {.shapes = {World::INSTANCE}},
        set_of({BUFFER_NODES, BUFFER_PRIMITIVES, BUFFER_SURFACES, BUFFER_ATTRIBUTES, BUFFER_LIGHTS}),
        spoil_sky);
}

}  // namespace
}  // namespace candela
