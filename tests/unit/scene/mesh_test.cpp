// Meshes: their positions and origins, attributes, and their place in the world.
#include "scene/mesh.h"

#include <bit>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gpu_scene/gpu_scene.h"
#include "probe/random.h"
#include "scene/geometry.h"
#include "scene/scene_builder.h"
#include "support/scene_builders.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

TriangleMesh with_positions(std::vector<dvec3> positions) {
    TriangleMesh mesh;
    set_positions(mesh, std::move(positions));
    return mesh;
}

dvec3 position(const TriangleMesh& mesh, size_t i) {
    return mesh.origin + dvec3(mesh.positions[i]);
}

Transform transform_of(const glm::dmat4& matrix) {
    Transform transform;
    EXPECT_TRUE(transform.append(matrix));
    return transform;
}

// Coordinates that floats can hold, of any size and at any distance, come out as they went in.
TEST(Mesh, PositionsThatAreFloatsLoseNothing) {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const float size = std::pow(10.0f, 12.0f * random.unit() - 6.0f);
        const float distance = std::pow(10.0f, 16.0f * random.unit() - 6.0f);
        const vec3 centre = distance * random.cube();
        std::vector<dvec3> positions;
        for (int corner = 0; corner < 20; ++corner)
            positions.emplace_back(centre + size * random.cube());
        const TriangleMesh mesh = with_positions(positions);
        for (size_t corner = 0; corner < positions.size(); ++corner)
            ASSERT_EQ(position(mesh, corner), positions[corner]);
    }
}

TEST(Mesh, TheOriginOfAMeshAroundZeroIsZero) {
    EXPECT_EQ(with_positions({dvec3(-1), dvec3(2)}).origin, dvec3(0));
    EXPECT_EQ(with_positions({dvec3(0), dvec3(1)}).origin, dvec3(0));
    EXPECT_EQ(with_positions({dvec3(7, 7, 7)}).origin, dvec3(0));  // A single point has no size.
    EXPECT_EQ(with_positions({}).origin, dvec3(0));
    EXPECT_EQ(with_positions({dvec3(-1000, 0, 0), dvec3(-999, 0, 0)}).origin, dvec3(-998, 0, 0));
}

// A mesh of one metre, two thousand kilometres away, where floats have steps of 12 cm.
TEST(Mesh, FarFromZeroPositionsAreRoundedToAPartOfTheSize) {
    Random random(2);
    const dvec3 centre(2e6, -1e6, 3e5);
    std::vector<dvec3> positions;
    for (int i = 0; i < 1000; ++i) {
        const dvec3 p = centre + 0.5 * dvec3(random.cube());
        positions.push_back(p + 1e-9 * dvec3(random.cube()));
    }
    const TriangleMesh mesh = with_positions(positions);
    for (size_t i = 0; i < positions.size(); ++i) {
        // A mesh of less than 1 m lies within 1.5 m of its origin, where floats round by at most 2^-24 m.
        const dvec3 error = abs(position(mesh, i) - positions[i]);
        ASSERT_LE(std::max({error.x, error.y, error.z}), 0x1p-24 + 1e-9);
    }
}

// A square whose corners differ in every attribute.
TriangleMesh square_of_everything() {
    TriangleMesh mesh = with_positions({dvec3(0), dvec3(1, 0, 0), dvec3(1, 1, 0), dvec3(0, 1, 0)});
    for (uint32_t i = 0; i < 4; ++i) {
        const auto x = float(i);
        mesh.normals.emplace_back(0, x, 1);
        mesh.tangents.emplace_back(1, x, 0, 1);
        mesh.uv0.emplace_back(x, 0);
        mesh.uv1.emplace_back(0, x);
        mesh.colors.emplace_back(x, 0, 0, 1);
    }
    mesh.triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)};
    return mesh;
}

void expect_same_vertex(const TriangleMesh& a, uint32_t i, const TriangleMesh& b, uint32_t j) {
    EXPECT_EQ(position(a, i), position(b, j));
    EXPECT_EQ(a.normals.at(i), b.normals.at(j));
    EXPECT_EQ(a.tangents.at(i), b.tangents.at(j));
    EXPECT_EQ(a.uv0.at(i), b.uv0.at(j));
    EXPECT_EQ(a.uv1.at(i), b.uv1.at(j));
    EXPECT_EQ(a.colors.at(i), b.colors.at(j));
}

TEST(Mesh, PartsKeepAllAttributesAndTheOrigin) {
    TriangleMesh mesh = square_of_everything();
    mesh.origin = dvec3(5e6, 1, 2);
    const std::vector<uint32_t> part_of{1, 0};
    const std::vector<TriangleMesh> parts = split_mesh(mesh, part_of, 2);
    ASSERT_EQ(parts.size(), 2u);
    for (size_t triangle = 0; triangle < 2; ++triangle) {
        const TriangleMesh& part = parts[part_of[triangle]];
        ASSERT_EQ(part.positions.size(), 3u);
        for (glm::length_t corner = 0; corner < 3; ++corner)
            expect_same_vertex(part, part.triangles[0][corner], mesh, mesh.triangles[triangle][corner]);
    }
}

TEST(Mesh, ACornerThatGetsANormalKeepsItsOtherAttributes) {
    TriangleMesh mesh = square_of_everything();
    mesh.normals[2] = vec3(0);
    TriangleMesh completed = mesh;
    complete_normals(completed);
    ASSERT_EQ(completed.positions.size(), 6u);  // Two more, for the triangles at the corner without one.
    mesh.normals[2] = vec3(0, 0, 1);
    for (size_t triangle = 0; triangle < 2; ++triangle) {
        for (glm::length_t corner = 0; corner < 3; ++corner) {
            expect_same_vertex(completed, completed.triangles[triangle][corner], mesh,
                               mesh.triangles[triangle][corner]);
        }
    }
}

TEST(Mesh, IsPlacedWithItsAttributes) {
    TriangleMesh mesh = square_of_everything();
    mesh.origin = dvec3(10, 0, 0);
    const Transform mirror =
        transform_of(glm::scale(glm::translate(glm::dmat4(1), dvec3(0, 0, 7)), dvec3(-2, 1, 1)));
    const TriangleMesh world = placed(mesh, mirror);
    EXPECT_EQ(world.origin, dvec3(0));
    EXPECT_EQ(world.positions[2], vec3(-22, 1, 7));
    EXPECT_EQ(world.normals[0], vec3(0, 0, 1));
    EXPECT_NEAR(length(world.normals[3]), 1.0f, 1e-6f);
    EXPECT_EQ(world.tangents[0], vec4(-1, 0, 0, -1));
    EXPECT_EQ(world.triangles[0], uvec3(0, 2, 1));  // The front stays the front.
    EXPECT_EQ(world.uv0, mesh.uv0);
    EXPECT_EQ(world.uv1, mesh.uv1);
    EXPECT_EQ(world.colors, mesh.colors);
}

// A mesh of one metre, made a million kilometres away and moved back: origin and transform are added before
// anything is rounded.
TEST(Mesh, IsPlacedInDoublePrecision) {
    const dvec3 far(1e9, 0, 0);
    const std::vector<dvec3> corners{dvec3(0.125, 0, 0), dvec3(1, 0, 0), dvec3(0, 1, 0.375)};
    const TriangleMesh mesh = with_positions({far + corners[0], far + corners[1], far + corners[2]});
    const TriangleMesh world = placed(mesh, transform_of(glm::translate(glm::dmat4(1), -far)));
    for (size_t i = 0; i < corners.size(); ++i)
        EXPECT_EQ(world.positions[i], vec3(corners[i]));
}

TEST(SceneBuilder, RefusesAMeshThatReachesTooFar) {
    Scene scene;
    add_diffuse(scene, vec3(0.5f));
    SceneBuilder builder(scene);
    TriangleMesh mesh = with_positions({dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)});
    mesh.triangles = {uvec3(0, 1, 2)};
    builder.add_mesh("place", Appearance{}, transform_of(glm::scale(glm::dmat4(1), dvec3(0.9e37))), mesh);
    EXPECT_EQ(error_of([&] {
                  builder.add_mesh("place", Appearance{},
                                   transform_of(glm::scale(glm::dmat4(1), dvec3(1.1e37))), mesh);
              }),
              "place: the shape reaches beyond 1e37 along an axis; check its numbers and its transform");
    EXPECT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(scene.meshes.size(), 1u);
}

// Two instances of one mesh; the second is mirrored, or so far away that a triangle vanishes.
TEST(GpuScene, PlacesEveryInstanceAndSaysWhatRoundingFlattens) {
    Scene scene;
    add_diffuse(scene, vec3(0.5f));
    scene.meshes.push_back(
        with_positions({dvec3(0), dvec3(1e-3, 0, 0), dvec3(0, 1e-3, 0), dvec3(0, 1e6, 0)}));
    scene.meshes[0].triangles = {uvec3(0, 1, 2), uvec3(0, 1, 3)};
    scene.shapes = {{.geometry = MeshInstance{0, {}}, .emission = {}},
                    {.geometry = MeshInstance{0, transform_of(glm::scale(glm::dmat4(1), dvec3(1, -1, 1)))},
                     .emission = Emission{vec3(1), false}}};
    EXPECT_TRUE(build_gpu_scene(scene).warnings.empty());
    EXPECT_EQ(build_gpu_scene(scene).id_count, 4u);
    EXPECT_EQ(bounds(scene).lo, dvec3(0, -1e6, 0));
    EXPECT_EQ(triangle_count(scene), 4u);

    const glm::dmat4 far = glm::translate(glm::dmat4(1), dvec3(0, 1e6, 0));
    scene.shapes[1].geometry = MeshInstance{0, transform_of(far)};
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    EXPECT_EQ(gpu.id_count, 3u);
    EXPECT_EQ(gpu.light_count, 1u);
    ASSERT_EQ(gpu.warnings.size(), 2u);  // A quarter of the triangles is too small.
    EXPECT_EQ(gpu.warnings[1],
              "left out 1 triangle too small for 32-bit coordinates in a scene of this size");
}

}  // namespace
}  // namespace candela
