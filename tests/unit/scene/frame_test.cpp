// The frame of a scene: how it is chosen, and that every record is made in it.
#include "scene/frame.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/make_identity.h"
#include "scene/mesh.h"
#include "shared/medium.h"
#include "unit/gpu_scene/packed_scene.h"

namespace candela {
namespace {

constexpr SceneFrame FRAME{.origin = {100, -200, 3e6}, .unit = 4};

TEST(SceneFrame, IsChosenFromTheBounds) {
    Scene scene;
    EXPECT_EQ(choose_frame(scene), SceneFrame{});
    add_shape(scene, Sphere{dvec3(10, 20, 30), 1.5}, 0);
    EXPECT_EQ(choose_frame(scene), (SceneFrame{.origin = {10, 20, 30}, .unit = 4}));
    add_shape(scene, Sphere{dvec3(10, 20, 94), 1.5}, 0);
    EXPECT_EQ(choose_frame(scene), (SceneFrame{.origin = {10, 20, 62}, .unit = 128}));
    scene.cameras.emplace_back().position = dvec3(1e9);
    EXPECT_EQ(choose_frame(scene).unit, 128) << "the camera has no say";
}

TEST(SceneFrame, TakesDifferencesInDoublePrecision) {
    EXPECT_EQ(FRAME.point(dvec3(100.5, -200.25, 3e6 + 0.125)), vec3(0.125f, -0.0625f, 0.03125f));
    EXPECT_EQ(FRAME.vector(dvec3(2, 4, 8)), vec3(0.5f, 1, 2));
    EXPECT_EQ(FRAME.length(2), 0.5f);
    EXPECT_EQ(FRAME.world(vec3(0.125f, -0.0625f, 0.03125f)), dvec3(100.5, -200.25, 3e6 + 0.125));
}

// Shapes around 0, and the same ones where the frame has them there.
Scene shapes_at(const SceneFrame& place) {
    Scene scene;
    add_material(scene, DielectricMaterial{.inside = {vec3(dvec3(1, 2, 3) / place.unit)}});
    const Emission emission{vec3(1, 2, 3), false};
    const auto at = [&](dvec3 p) { return place.origin + place.unit * p; };
    add_shape(scene, Quad{{at({0, 0, 0}), at({2, 0, 0}), at({3, 3, 0}), at({0, 2, 0})}}, 0, emission);
    add_shape(scene, Sphere{at({1, -1, 0.5}), 0.25 * place.unit}, 0, emission);
    add_shape(scene, Disk{at({0, 0, -1}), place.unit * dvec3(1, 0, 0), place.unit * dvec3(0, 0.5, 0)}, 0,
              emission);
    TriangleMesh mesh;
    set_positions(mesh, {at({0, 0, 1}), at({1, 0, 1}), at({0, 1, 1.25})});
    mesh.normals = {vec3(0, 0, 1), vec3(0, 1, 1), vec3(1, 0, 1)};
    mesh.triangles = {uvec3(0, 1, 2)};
    add_shape(scene, mesh, 0, emission);
    scene.environment = Environment{.size = {1, 2}, .radiance = {vec3(1), vec3(2)}};
    Camera camera;
    camera.position = at({1, 2, 3});
    camera.look_at = at({0, 0, 1});
    camera.vertical_fov = 1.0f;
    camera.lens = {.radius = float(0.125 * place.unit), .focal_distance = float(2 * place.unit)};
    scene.cameras = {camera};
    return scene;
}

TEST(SceneFrame, AllRecordsAreMadeInIt) {
    const Scene here = shapes_at({}), there = shapes_at(FRAME);
    const GpuScene a = build_gpu_scene(here, SceneFrame{}), b = build_gpu_scene(there, FRAME);
    for (size_t i = 0; i < a.arrays.size(); ++i)
        EXPECT_EQ(a.arrays[i], b.arrays[i]) << "array " << i;
    EXPECT_EQ(pack(make_parameters(a, here.cameras[0], {})), pack(make_parameters(b, there.cameras[0], {})));
}

TEST(SceneFrame, BelongsToTheIdentity) {
    const Scene scene = shapes_at({});
    const Camera& camera = scene.cameras[0];
    const Identity ours = make_identity(build_gpu_scene(scene, SceneFrame{}), camera, {});
    const Identity theirs = make_identity(build_gpu_scene(scene, SceneFrame{.unit = 2}), camera, {});
    const std::string text = difference(theirs, ours);
    EXPECT_EQ(
        text,
        "it shows another scene, or another version of it, its frame is origin 0 0 0, unit 2 m, records 6, "
        "not origin 0 0 0, unit 1 m, records 6");
    Image image;
    set_identity(image, ours);
    EXPECT_EQ(difference(identity_of(image, "a.exr"), ours), "its size is 0x0, not 512x512");
    image.attributes.erase("candela.frame");
    const Identity older = identity_of(image, "a.exr");
    EXPECT_EQ(difference(ours, older).find("another scene"), std::string::npos) << "it need not be";
    EXPECT_NE(difference(identity_of(image, "a.exr"), ours)
                  .find("its frame is that of an older candela, not origin"),
              std::string::npos);
}

// A grid of cells of 1 mm, and another triangle that makes the scene so large.
Scene grid_in_a_scene_of(double size) {
    Scene scene;
    add_diffuse(scene, vec3(0.5f));
    TriangleMesh mesh;
    set_positions(mesh, {dvec3(size), dvec3(0), dvec3(size, 0, 0)});
    mesh.triangles = {uvec3(0, 1, 2)};
    add_shape(scene, mesh, 0);
    std::vector<dvec3> positions;
    for (int i = 0; i < 60; ++i)
        positions.push_back(dvec3(0.001 * (i % 3), 0.001 * (i / 3), size));
    TriangleMesh grid;
    set_positions(grid, std::move(positions));
    for (uint32_t i = 0; i + 3 < 60; i += 3)
        grid.triangles.emplace_back(i, i + 1, i + 3);
    add_shape(scene, grid, 0);
    return scene;
}

TEST(SceneFrame, TooLargeASceneForItsDetailsIsAWarning) {
    EXPECT_TRUE(build_gpu_scene(grid_in_a_scene_of(500)).warnings.empty());
    // 16 steps of 2^-23 of half of the size are 1 mm at 1049 m.
    EXPECT_TRUE(build_gpu_scene(grid_in_a_scene_of(1000)).warnings.empty());
    EXPECT_EQ(
        build_gpu_scene(grid_in_a_scene_of(1100)).warnings,
        std::vector<std::string>{
            "19 of 20 triangles are smaller than 16 steps of 32-bit coordinates in a scene of this size, "
            "2.05e+03 m: they look rough; render what is far apart by itself"});
}

// A small ball 0.5 units from the middle, which rounding moves by 2^-24 times four times that.
TEST(SceneFrame, TooLargeASceneForItsBallsIsAWarning) {
    const auto warnings = [](double radius) {
        Scene scene;
        add_shape(scene, Quad{{dvec3(-64, 0, 0), dvec3(64, 0, 0), dvec3(64, 1, 0), dvec3(-64, 1, 0)}},
                  add_material(scene, DiffuseMaterial{}));
        add_shape(scene, Sphere{dvec3(64, 0, 0), radius}, 0);
        return build_gpu_scene(scene).warnings;
    };
    constexpr double ERROR = 4.0 * 64.0 * 0x1p-24;
    EXPECT_TRUE(warnings(ERROR / 0.029).empty());
    EXPECT_EQ(
        warnings(ERROR / 0.031),
        std::vector<std::string>{
            "1 of 1 spheres are too small for 32-bit coordinates in a scene of this size, 256 m: rounding "
            "moves them by more than 3 % of their radius; render what is far apart by itself"});
}

}  // namespace
}  // namespace candela
