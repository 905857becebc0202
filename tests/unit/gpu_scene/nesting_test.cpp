// Solids with media: which may lie within each other, and which no light sample reaches.
#include "gpu_scene/nesting.h"

#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu_scene/gpu_scene.h"
#include "probe/scenes.h"

namespace candela {
namespace {

DielectricMaterial medium(float ior) {
    return {.ior = ior};
}

bool may_nest(const Scene& scene) {
    return build_gpu_scene(scene).nested_media;
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
    EXPECT_EQ(
        build_gpu_scene(scene).warnings,
        std::vector<std::string>{"shape 3 (material \"tea\"): the mesh is not closed, so rays may leave the "
                                 "medium without crossing its surface, and remain in it; close the mesh"});
    // For clear glass, it does not matter, unless something else is in it.
    scene.materials[1].model = DielectricMaterial{};
    scene.shapes.erase(scene.shapes.begin() + 1);
    EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
    add_shape(scene, Sphere{dvec3(0), 0.5}, 1);
    EXPECT_EQ(build_gpu_scene(scene).warnings.size(), 1u);
}

// The vertices of `mesh`, and its triangles with the front on the other side, after those of `target`.
void append_mesh(TriangleMesh& target, const TriangleMesh& mesh, bool inside_out = false) {
    const auto first = uint32_t(target.positions.size());
    target.positions.insert(target.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const uvec3 t : mesh.triangles)
        target.triangles.push_back(first + (inside_out ? uvec3(t.x, t.z, t.y) : t));
}

TriangleMesh ball(float x, float radius) {
    return transformed(sphere_mesh(8, 12), [=](vec3 p) { return radius * p + vec3(x, 0, 0); });
}

TEST(MediaMayNest, WherePartsOfAMeshOverlap) {
    const auto nests = [](const TriangleMesh& mesh) {
        Scene scene;
        add_shape(scene, mesh, add_material(scene, medium(1.5f)));
        EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
        return may_nest(scene);
    };
    TriangleMesh apart = ball(0, 1), overlapping = apart, hollow = apart, filled = apart, open = apart;
    EXPECT_FALSE(nests(apart));
    append_mesh(apart, ball(2.5f, 1));
    EXPECT_FALSE(nests(apart));
    append_mesh(overlapping, ball(1.5f, 1));
    EXPECT_TRUE(nests(overlapping));
    append_mesh(filled, ball(0, 0.5f));
    EXPECT_TRUE(nests(filled));
    append_mesh(hollow, ball(0, 0.5f), true);
    EXPECT_FALSE(nests(hollow));
    append_mesh(hollow, ball(0, 0.25f));
    EXPECT_TRUE(nests(hollow)) << "a ball in the hollow of another";
    append_mesh(open, ball(1.5f, 1));
    open.triangles.pop_back();
    EXPECT_FALSE(nests(open)) << "by its sides alone, clear glass with a hole has no inside";
}

// So many balls that overlap only along an axis are taken to overlap, instead of compared pair by pair.
TEST(MediaMayNest, WhereAMeshHasVeryManyParts) {
    TriangleMesh tetrahedra;
    for (int i = 0; i < 6000; ++i) {
        const vec3 p(0.0f, 2.0f * float(i % 80), 2.0f * float(i / 80));
        const auto first = uint32_t(tetrahedra.positions.size());
        for (const vec3 corner : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
            tetrahedra.positions.push_back(p + corner);
        for (const uvec3 t : {uvec3(0, 2, 1), uvec3(0, 1, 3), uvec3(0, 3, 2), uvec3(1, 2, 3)})
            tetrahedra.triangles.push_back(first + t);
    }
    Scene scene;
    add_shape(scene, tetrahedra, add_material(scene, medium(1.5f)));
    EXPECT_TRUE(may_nest(scene));
    scene.meshes[0].triangles.resize(4 * 5000);
    EXPECT_FALSE(may_nest(scene));
}

// A ball whose vertices along one meridian, and at the poles, are there twice: rounding moves one of them
// along each axis.
TriangleMesh ball_with_a_seam(float shift) {
    constexpr uint32_t RINGS = 12, SEGMENTS = 24;
    TriangleMesh mesh;
    for (uint32_t j = 0; j <= RINGS; ++j) {
        for (uint32_t i = 0; i <= SEGMENTS; ++i) {
            const double theta = double(PI) * j / RINGS, phi = 2.0 * double(PI) * (i % SEGMENTS) / SEGMENTS;
            const dvec3 p(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
            mesh.positions.push_back(vec3(p) + (i == SEGMENTS ? shift : 0.0f));
        }
    }
    for (uint32_t j = 0; j < RINGS; ++j) {
        for (uint32_t i = 0; i < SEGMENTS; ++i) {
            const uint32_t a = j * (SEGMENTS + 1) + i, b = a + 1, c = a + SEGMENTS + 1;
            if (j > 0) mesh.triangles.emplace_back(a, c, b);
            if (j + 1 < RINGS) mesh.triangles.emplace_back(b, c, c + 1);
        }
    }
    return mesh;
}

// Floats between 0.5 and 1 have steps of 2^-24.
TEST(MediaMayNest, ASeamThatRoundingOpensIsClosed) {
    for (const double size : {1e-3, 1.0, 1e4}) {
        const auto warnings = [&](float shift) {
            Scene scene;
            const uint32_t tea = add_material(scene, DielectricMaterial{.inside = {vec3(1)}});
            add_shape(scene, transformed(ball_with_a_seam(shift), [&](vec3 p) { return float(size) * p; }),
                      tea);
            return build_gpu_scene(scene).warnings.size();
        };
        for (const float shift : {0.0f, 1e-30f, -1e-16f, 0x1p-24f, -0x1p-24f, 0x3p-24f})
            EXPECT_EQ(warnings(shift), 0u) << shift;
        for (const float shift : {0x6p-24f, -0x6p-24f, 0x1p-20f, 1e-3f})
            EXPECT_EQ(warnings(shift), 1u) << shift;
    }
}

TEST(MediaMayNest, FiveWithinEachOtherAreTooMany) {
    Scene scene;
    const uint32_t glass = add_material(scene, medium(1.5f));
    for (int i = 1; i <= 4; ++i)
        add_shape(scene, Sphere{dvec3(0), double(i)}, glass);
    EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
    add_shape(scene, Sphere{dvec3(0), 0.5}, glass);
    EXPECT_EQ(build_gpu_scene(scene).warnings,
              std::vector<std::string>{"shape 4 may lie within 4 other solids; a path can track 4 media, and "
                                       "drops the one with the lowest priority that it entered first"});
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
TEST(MediaMayNest, WhereBoxesOfOneMaterialOverlap) {
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

// A pane of 6 m, as quads, as a mesh and as a scaled instance of one, turned so that no axis is its normal.
// 16 steps of 2^-23 of 8 m are 15 um.
TEST(MediaMayNest, WhereASolidIsTooThin) {
    const auto scene_of = [](double thickness) {
        Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.5f);
        add_box(scene, dvec3(-3, -3, 0), dvec3(3, 3, thickness), add_material(scene, medium(1.5f)));
        return scene;
    };
    EXPECT_FALSE(may_nest(scene_of(1e-4)));
    EXPECT_TRUE(build_gpu_scene(scene_of(1e-4)).warnings.empty());
    EXPECT_TRUE(may_nest(scene_of(1e-6)));
    const std::string text =
        " m of the scene and its cameras, so rays may miss one of its sides; make it thicker, or use a "
        "thin "
        "wall";
    EXPECT_EQ(build_gpu_scene(scene_of(1e-6)).warnings,
              std::vector<std::string>{
                  "shape 0: the solid is 1e-06 m thick, less than 16 steps of 32-bit coordinates over the 6" +
                  text});
    Scene two = scene_of(1e-5);
    add_box(two, dvec3(-3, -3, 1), dvec3(3, 3, 1 + 5e-6), 0);
    const std::vector<std::string> warnings = build_gpu_scene(two).warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].starts_with("shape 6: the solid is 5e-06 m thick")) << warnings[0];
    EXPECT_TRUE(warnings[0].ends_with(" (and 1 more)")) << warnings[0];

    TriangleMesh cube;
    for (uint32_t i = 0; i < 8; ++i)
        cube.positions.emplace_back(i & 1u, i >> 1u & 1u, i >> 2u);
    for (const auto& [a, b, c, d] : std::initializer_list<std::array<uint32_t, 4>>{
             {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
        cube.triangles.emplace_back(a, b, c);
        cube.triangles.emplace_back(a, c, d);
    }
    const auto instance_nests = [&](double thickness) {
        Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.5f);
        add_shape(scene, cube, add_material(scene, medium(1.5f)));
        Transform transform;
        EXPECT_TRUE(transform.append(glm::dmat4(6, 0, 0, 0, 0, 6, 0, 0, 0, 0, thickness, 0, 0, 0, 0, 1)));
        const double c = std::cos(0.5), s = std::sin(0.5);
        EXPECT_TRUE(transform.append(glm::dmat4(c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1)));
        std::get<MeshInstance>(scene.shapes[0].geometry).transform = transform;
        return may_nest(scene);
    };
    EXPECT_FALSE(instance_nests(1e-4));
    EXPECT_TRUE(instance_nests(1e-6));
}

bool sealed(const Scene& scene) {
    return build_gpu_scene(scene).sealed_media;
}

// Paths take no light samples in sealed solids, so that none may lack one.
TEST(SealedMedia, NoLightReachesTheInsideOfASolidThatScatters) {
    const Medium milk{.scattering = vec3(1)};
    Scene scene;
    add_shape(scene, Sphere{dvec3(0), 1.0}, add_material(scene, DielectricMaterial{.inside = milk}));
    scene.lights = {{"", PointLight{dvec3(0, 3, 0), vec3(1)}}};
    EXPECT_TRUE(sealed(scene));

    Scene other = scene;
    other.materials[0].model = DielectricMaterial{};
    EXPECT_FALSE(sealed(other)) << "Nothing scatters.";
    other.materials[0].model = InterfaceMaterial{milk};
    EXPECT_FALSE(sealed(other)) << "Shadow rays pass.";
    other = scene;
    other.materials[0].opacity.value = 0.5f;
    EXPECT_FALSE(sealed(other)) << "Some shadow rays pass.";
    other = scene;
    std::get<PointLight>(other.lights[0].model).position = dvec3(0, 0.5, 0);
    EXPECT_FALSE(sealed(other)) << "The light is within.";
    other = scene;
    add_shape(other, Sphere{dvec3(0), 0.1}, add_material(other, DiffuseMaterial{}), Emission{vec3(1)});
    EXPECT_FALSE(sealed(other)) << "A lamp is within.";
}

// A light beside them may come in by another solid.
TEST(SealedMedia, SolidsThatTouchCountTogether) {
    Scene scene;
    add_shape(scene, Sphere{dvec3(0), 1.0},
              add_material(scene, DielectricMaterial{.inside = {.scattering = vec3(1)}}));
    add_shape(scene, Sphere{dvec3(1.5, 0, 0), 1.0}, add_material(scene, DielectricMaterial{}));
    EXPECT_TRUE(sealed(scene));
    scene.lights = {{"", PointLight{dvec3(1.8, 0, 0), vec3(1)}}};
    EXPECT_FALSE(sealed(scene));
    scene.lights.clear();
    scene.materials[1].model = InterfaceMaterial{};
    EXPECT_FALSE(sealed(scene));
    std::get<Sphere>(scene.shapes[1].geometry).center.x = 2.5;
    EXPECT_TRUE(sealed(scene));
}

// Paths find a sky or a lamp through an opening, but no point.
TEST(SealedMedia, OpenMeshesLetPointsOfLightIn) {
    Scene scene;
    TriangleMesh bowl = sphere_mesh(16, 24);
    bowl.triangles.resize(bowl.triangles.size() / 2);
    add_shape(scene, bowl, add_material(scene, DielectricMaterial{.inside = {.scattering = vec3(1)}}));
    scene.environment = Environment{.radiance = {vec3(1)}};
    EXPECT_TRUE(sealed(scene));
    scene.lights = {{"", DirectionalLight{}}};
    EXPECT_FALSE(sealed(scene));
}

}  // namespace
}  // namespace candela
