// The media that the host finds at a point.
#include "render/media_at.h"

#include <gtest/gtest.h>

#include "probe/scenes.h"

namespace candela {
namespace {

constexpr uint32_t PRIORITY = 1u << MEDIUM_INDEX_BITS;

DielectricMaterial medium(float ior, uint32_t priority = 0) {
    return {.ior = ior, .priority = priority};
}

uvec2 media(const Scene& scene, dvec3 point) {
    return media_at(build_gpu_scene(scene), point);
}

TEST(MediaAt, NothingEnclosesAPointOutside) {
    Scene scene;
    add_shape(scene, Sphere{dvec3(0), 1.0}, add_material(scene, DiffuseMaterial{}));
    EXPECT_EQ(media(scene, dvec3(0)), uvec2(0));  // Nor does an opaque ball.
    add_shape(scene, Sphere{dvec3(10), 1.0}, add_material(scene, medium(1.5f)));
    EXPECT_EQ(media(scene, dvec3(0)), uvec2(0));
    EXPECT_EQ(media(scene, dvec3(10, 8.9, 10)), uvec2(0));  // The ray enters the ball and leaves it.
    EXPECT_EQ(media(scene, dvec3(10, 9.1, 10)), uvec2(1, 0));
    EXPECT_EQ(media(scene, dvec3(10, 11.1, 10)), uvec2(0));
}

TEST(MediaAt, BallsWithinBallsTheInnermostFirst) {
    Scene scene;
    for (const float radius : {3.0f, 1.0f, 2.0f})
        add_shape(scene, Sphere{dvec3(0.3, 0.1, 0.2), radius}, add_material(scene, medium(1.0f + radius)));
    EXPECT_EQ(media(scene, dvec3(0)), uvec2(2 | 3 << 16, 1));
    EXPECT_EQ(media(scene, dvec3(1.5, 0, 0)), uvec2(3 | 1 << 16, 0));
    EXPECT_EQ(media(scene, dvec3(0, -2.5, 0)), uvec2(1, 0));
}

TEST(MediaAt, AHigherPriorityComesFirst) {
    Scene scene;
    for (const float radius : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f})
        add_shape(scene, Sphere{dvec3(0), radius},
                  add_material(scene, medium(1.0f + radius, radius == 3.0f ? 2 : 0)));
    // The outermost of five is left out.
    EXPECT_EQ(media(scene, dvec3(0.1)), uvec2((2 * PRIORITY | 3) | 1 << 16, 2 | 4 << 16));
}

TEST(MediaAt, MeshesHaveAnInside) {
    Scene scene;
    add_shape(scene, transformed(sphere_mesh(16, 24), [](vec3 p) { return 2.0f * p + vec3(5, 0, 0); }),
              add_material(scene, medium(1.5f)));
    for (const double x : {3.1, 4.0, 5.0, 6.9})
        EXPECT_EQ(media(scene, dvec3(x, 0.01, 0.02)), uvec2(1, 0)) << x;
    for (const dvec3 p : {dvec3(2.9, 0, 0), dvec3(5, -2.1, 0), dvec3(5, 2.1, 0), dvec3(5, 0, 2.1)})
        EXPECT_EQ(media(scene, p), uvec2(0));
}

// Two instances of a ball of radius 1, the second mirrored, sheared and of a medium of its own.
TEST(MediaAt, InstancesHaveAnInside) {
    Scene scene;
    add_shape(scene, sphere_mesh(16, 24), add_material(scene, medium(1.5f)));
    const uint32_t other = add_material(scene, medium(1.3f));
    Transform transform;
    ASSERT_TRUE(transform.append(glm::dmat4(-2, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1)));
    scene.shapes.push_back({.geometry = MeshInstance{0, transform}, .material = other, .emission = {}});
    const GpuScene instanced =
        build_gpu_scene(scene, choose_frame(scene), {.min_uses = 1, .min_triangles = 1});
    ASSERT_EQ(instanced.instances.size(), 2u);
    for (const dvec3 p : {dvec3(0.1), dvec3(0.9, 0.1, 0), dvec3(0, 1.1, 0), dvec3(3.1, 0.01, 0),
                          dvec3(2.9, 0, 0), dvec3(5.5, 0.8, 0.1), dvec3(3.9, 0.8, 0.1), dvec3(5, 0, 1.1)})
        EXPECT_EQ(media_at(instanced, p), media(scene, p)) << p.x << ' ' << p.y;
    EXPECT_EQ(media_at(instanced, dvec3(0.1)), uvec2(1, 0));
    EXPECT_EQ(media_at(instanced, dvec3(5.5, 0.8, 0.1)), uvec2(2, 0));
}

TEST(MediaAt, UnderTheSurfaceOfALake) {
    Scene scene;
    const uint32_t water = add_material(scene, medium(1.33f));
    add_shape(scene, Disk{dvec3(0), dvec3(0, 0, 50), dvec3(50, 0, 0)}, water);
    EXPECT_EQ(media(scene, dvec3(1, -2, 3)), uvec2(1, 0));
    EXPECT_EQ(media(scene, dvec3(1, 2, 3)), uvec2(0));
    EXPECT_EQ(media(scene, dvec3(60, -2, 3)), uvec2(0));  // Beside it.
}

}  // namespace
}  // namespace candela
