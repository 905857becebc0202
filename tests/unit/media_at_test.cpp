// Which media the host finds at a point, and when media may lie within each other.
#include "gpu_scene/media_at.h"

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

bool may_nest(const Scene& scene) {
    return build_gpu_scene(scene).nested_media;
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
        build_gpu_scene(scene, choose_frame(scene), {.least_uses = 1, .least_triangles = 1});
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

TEST(MediaMayNest, WhereBoxesOverlap) {
    Scene scene;
    const uint32_t glass = add_material(scene, medium(1.5f));
    const uint32_t water = add_material(scene, medium(1.33f));
    add_shape(scene, Sphere{dvec3(0), 1.0}, glass);
    add_shape(scene, Sphere{dvec3(0), 0.5}, add_material(scene, DiffuseMaterial{}));
    add_shape(scene, Sphere{dvec3(2.0, 0, 0), 1.0}, water);  // Touches the first.
    EXPECT_FALSE(may_nest(scene));
    Scene overlapping = scene;
    add_shape(overlapping, Sphere{dvec3(-1.4, 0, 0), 0.5}, water);
    EXPECT_TRUE(may_nest(overlapping));
}

TEST(MediaMayNest, HolesAreNamed) {
    TriangleMesh ball = sphere_mesh(8, 12);
    Scene scene;
    scene.materials = {{"stone", DiffuseMaterial{}}, {"tea", DielectricMaterial{.inside = {vec3(1)}}}};
    add_shape(scene, ball, 0);
    add_shape(scene, ball, 1);
    EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
    ball.triangles.pop_back();
    add_shape(scene, ball, 0);
    EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
    add_shape(scene, ball, 1);
    EXPECT_EQ(build_gpu_scene(scene).warnings,
              std::vector<std::string>{
                  "shape 3 (material \"tea\"): the mesh is not closed, so that rays may leave the "
                  "medium inside without passing its surface, and stay in it; close the mesh"});
    // Of clear glass, it does not matter, unless something else is in it.
    scene.materials[1].model = DielectricMaterial{};
    scene.shapes.erase(scene.shapes.begin() + 1);
    EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
    add_shape(scene, Sphere{dvec3(0), 0.5}, 1);
    EXPECT_EQ(build_gpu_scene(scene).warnings.size(), 1u);
}

TEST(MediaMayNest, FiveWithinEachOtherAreTooMany) {
    Scene scene;
    const uint32_t glass = add_material(scene, medium(1.5f));
    for (int i = 1; i <= 4; ++i)
        add_shape(scene, Sphere{dvec3(0), double(i)}, glass);
    EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
    add_shape(scene, Sphere{dvec3(0), 0.5}, glass);
    EXPECT_EQ(
        build_gpu_scene(scene).warnings,
        std::vector<std::string>{"shape 4 may lie within 4 other solids; a path keeps 4 media in mind, and "
                                 "forgets the one with the lowest priority that it entered first"});
}

// The walls of a box are one solid, though none of them overlaps another's box.
TEST(MediaMayNest, ABallInABoxOfQuads) {
    const auto boxes = [](double centre) {
        Scene scene;
        const uint32_t glass = add_material(scene, medium(1.5f));
        add_shape(scene, parallelogram(vec3(-1, -1, -1), vec3(2, 0, 0), vec3(0, 0, 2)), glass);
        add_shape(scene, parallelogram(vec3(-1, 1, -1), vec3(0, 0, 2), vec3(2, 0, 0)), glass);
        add_shape(scene, Sphere{dvec3(centre), 0.5}, add_material(scene, medium(1.33f)));
        return may_nest(scene);
    };
    EXPECT_TRUE(boxes(0.0));
    EXPECT_FALSE(boxes(3.0));
}

void add_box(Scene& scene, dvec3 lo, dvec3 hi, uint32_t material) {
    constexpr uint8_t SIDES[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& side : SIDES) {
        Quad quad;
        for (size_t i = 0; i < 4; ++i) {
            const uint8_t c = side[i];
            quad.corners[i] =
                dvec3((c & 1u) != 0 ? hi.x : lo.x, (c & 2u) != 0 ? hi.y : lo.y, (c & 4u) != 0 ? hi.z : lo.z);
        }
        add_shape(scene, quad, material);
    }
}

// A table and a leg that is let into it are two solids, though of one glass.
TEST(MediaAt, BoxesOfOneMaterialNestWhereTheyOverlap) {
    const auto nests = [](double top) {
        Scene scene;
        const uint32_t glass = add_material(scene, medium(1.5f));
        add_box(scene, dvec3(-5, 1, -5), dvec3(5, 2, 5), glass);
        add_box(scene, dvec3(-1, 0, -1), dvec3(1, top, 1), glass);
        return may_nest(scene);
    };
    EXPECT_TRUE(nests(1.1));
    EXPECT_FALSE(nests(0.9));
    // The surface and the bottom of a lake belong together.
    Scene lake;
    const uint32_t water = add_material(lake, medium(1.33f));
    add_shape(lake, parallelogram(vec3(-9, 0, 9), vec3(18, 0, 0), vec3(0, 0, -18)), water);
    add_shape(lake, parallelogram(vec3(-9, -4, 9), vec3(0, 0, -18), vec3(18, 0, 0)), water);
    EXPECT_FALSE(may_nest(lake));
    add_shape(lake, Sphere{dvec3(0, -2, 0), 1.0}, add_material(lake, medium(1.5f)));
    EXPECT_TRUE(may_nest(lake));
}

}  // namespace
}  // namespace candela
