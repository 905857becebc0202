// A renderer that goes on with a scene in which something has changed makes the picture of a fresh one.
#include <functional>

#include "gpu_scene/scene_stages.h"
#include "render/render_fixture.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

const InstancingRule RULE{.min_uses = 2, .min_triangles = 1};

Transform at(dvec3 place) {
    glm::dmat4 matrix(1.0);
    matrix[3] = glm::dvec4(place.x, place.y, place.z, 1.0);
    Transform transform;
    transform.append(matrix);
    return transform;
}

// Two instances of a ball over a floor, under a lamp and a sky that is not even.
Scene balls() {
    Scene scene = scene_with_camera(dvec3(0, 3, 9), dvec3(0), 1.0f);
    const uint32_t grey = add_diffuse(scene, vec3(0.5f));
    scene.meshes.push_back(sphere_mesh(6, 8));
    for (const double x : {-1.5, 1.5})
        scene.shapes.push_back(
            {.geometry = MeshInstance{0, at(dvec3(x, 1, 0))}, .material = grey, .emission = {}});
    add_shape(scene, Quad{{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}}, grey);
    add_shape(scene, Quad{{{-1, 6, -1}, {1, 6, -1}, {1, 6, 1}, {-1, 6, 1}}}, grey, Emission{vec3(5), false});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(0.2f), vec3(0.4f, 0.5f, 0.6f)}};
    return scene;
}

class UpdateTest : public RenderTest {
  protected:
    UpdateTest() : scene_(balls()), stages_(scene_, {.rule = RULE}) {}

    // The renderer takes what has changed, as a fresh one takes the whole scene.
    void expect_as_fresh(const vk::Device& device, Renderer& renderer, const RenderSettings& settings,
                         const SceneChange& change) {
        const SceneFrame before = stages_.joined().frame;
        const Camera& camera = scene_.cameras[0];
        renderer.reset(stages_.joined(), camera, settings, stages_.update(scene_, change));
        Renderer fresh(device, build_gpu_scene(scene_, choose_frame(scene_), RULE), camera, settings);
        for (Renderer* one : {&renderer, &fresh})
            EXPECT_TRUE(one->render(2, [](double) { return true; }));
        EXPECT_TRUE(renderer.download().values == fresh.download().values);
        EXPECT_EQ(renderer.array_map(), fresh.array_map());
        if (stages_.joined().frame == before) return;
        EXPECT_EQ(renderer.positions(), fresh.positions());
    }

    void move_to(dvec3 place) { std::get<MeshInstance>(scene_.shapes[0].geometry).transform = at(place); }

    Scene scene_;
    SceneStages stages_;
};

TEST_F(UpdateTest, EachChangeGivesThePictureOfAFreshScene) {
    const RenderSettings settings = settings_for(24, 16);
    Renderer renderer(device(), stages_.joined(), scene_.cameras[0], settings);
    scene_.environment->radiance[0] = vec3(1, 2, 3);
    expect_as_fresh(device(), renderer, settings, {.environment = true});
    move_to(dvec3(-0.5, 2, 1));
    expect_as_fresh(device(), renderer, settings, {.moved = {0}});
    scene_.materials[0].model = DiffuseMaterial{vec3(0.2f, 0.7f, 0.5f)};
    expect_as_fresh(device(), renderer, settings, {.materials = true});
    move_to(dvec3(-40, 2, 1));  // In another frame.
    expect_as_fresh(device(), renderer, settings, {.moved = {0}});
    // Other constants.
    scene_.environment.reset();
    scene_.materials[0].model = ConductorMaterial{vec3(0.8f), 0.3f};
    expect_as_fresh(device(), renderer, settings, {.environment = true, .materials = true});
    // The balls become lamps, and one of them moves.
    for (const size_t i : {0, 1})
        scene_.shapes[i].emission = Emission{vec3(1, 2, 3), false};
    expect_as_fresh(device(), renderer, settings, {.shapes = {0, 1}});
    EXPECT_NE(stages_.joined().lights_present & 1u << LIGHT_LAMP, 0u);
    move_to(dvec3(-2, 3, 1));
    expect_as_fresh(device(), renderer, settings, {.moved = {0}});
}

// Its arrays then have what kernels read that it shares with others.
TEST_F(UpdateTest, SoItDoesWhereASceneBecomesASmallModel) {
    scene_.shapes.resize(2);
    scene_.environment.reset();
    scene_.lights.push_back({"", PointLight{{0, 5, 5}, vec3(30)}});
    stages_ = SceneStages(scene_, {.rule = RULE});
    const RenderSettings settings = settings_for(24, 16);
    Renderer renderer(device(), stages_.joined(), scene_.cameras[0], settings);
    scene_.materials[0].model = PrincipledMaterial{};
    expect_as_fresh(device(), renderer, settings, {.materials = true});
    scene_.materials[0].model = DiffuseMaterial{vec3(0.5f)};
    expect_as_fresh(device(), renderer, settings, {.materials = true});
}

// Most arrays lie in one of them, each behind the others.
TEST_F(UpdateTest, SoItDoesInStorageBuffersWhereArraysGrow) {
    RenderSettings settings = settings_for(24, 16);
    settings.scene_access = SceneAccess::storage_buffers;
    info_.limits.max_per_stage_descriptor_storage_buffers = 4;
    const vk::Device device(instance_, info_);
    Renderer renderer(device, stages_.joined(), scene_.cameras[0], settings);
    scene_.environment->size = {3, 4};
    scene_.environment->radiance.resize(12, vec3(0.1f, 0.2f, 0.3f));
    expect_as_fresh(device, renderer, settings, {.environment = true});
    scene_.meshes[0].triangles.resize(scene_.meshes[0].triangles.size() / 2);
    expect_as_fresh(device, renderer, settings, {.meshes = {0}});
}

// Arrays that did not change and lie where they did are not copied again.
TEST_F(UpdateTest, OnlyWhatChangedIsCopied) {
    for (const SceneAccess access : {SceneAccess::texel_buffers, SceneAccess::storage_buffers}) {
        Scene scene = balls();
        SceneStages stages(scene, {.rule = RULE});
        const auto map = [&] { return map_arrays(device().info(), stages.joined(), access); };
        SceneBuffers buffers(device(), stages.joined(), {}, map());
        scene.environment->radiance[0] = vec3(1, 2, 3);
        // Its texels and the table that chooses one.
        EXPECT_EQ(buffers.update(stages.joined(), map(), stages.update(scene, {.environment = true})), 2u);
        EXPECT_EQ(buffers.update(stages.joined(), map(), {}), 0u);
        std::get<MeshInstance>(scene.shapes[0].geometry).transform = at(dvec3(-1.499, 1, 0));
        EXPECT_EQ(buffers.update(stages.joined(), map(), stages.update(scene, {.moved = {0}})), 1u);
    }
}

// In a storage buffer that several share, one that did not change may lie elsewhere, although all together
// are as long as before.
TEST_F(UpdateTest, WhatOthersMoveIsCopied) {
    vk::DeviceInfo info = info_;
    info.limits.max_per_stage_descriptor_storage_buffers = 4;
    GpuScene scene;
    const auto resize = [&](uint32_t lights, uint32_t environment) {
        scene.arrays[ARRAY_LIGHTS] = std::vector<uvec4>(lights);
        scene.arrays[ARRAY_ENVIRONMENT] = std::vector<uvec4>(environment);
    };
    const auto map = [&] { return map_arrays(info, scene, SceneAccess::storage_buffers); };
    scene.arrays[ARRAY_NODES] = std::vector<uvec4>(20);
    scene.arrays[ARRAY_PRIMITIVES] = std::vector<uvec4>(20);
    scene.arrays[ARRAY_MATERIALS] = std::vector<uvec4>(6);
    resize(8, 4);
    SceneBuffers buffers(device(), scene, {}, map());
    const uint32_t before = map().starts[ARRAY_MATERIALS];
    resize(5, 7);
    ASSERT_NE(map().starts[ARRAY_MATERIALS], before);
    EXPECT_EQ(buffers.update(scene, map(), BufferSet().set(BUFFER_LIGHTS).set(BUFFER_ENVIRONMENT)), 3u);
}

}  // namespace
}  // namespace candela
