// Quads, boxes and meshes of a scene file: what is refused, and the questions about a whole scene.
#include "scene/geometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

std::string quad(const std::string& vertices) {
    return scene_of(R"({"type": "quad", "material": "white", "vertices": )" + vertices + "}");
}

std::string white_mesh(const std::string& members) {
    return scene_of(R"({"type": "mesh", "material": "white", )" + members + "}");
}

TEST(Geometry, AcceptsGeneralQuads) {
    SceneFolder folder;
    EXPECT_NO_THROW(folder.load(quad("[[552.8, 0, 0], [0, 0, 0], [0, 0, 559.2], [549.6, 0, 559.2]]")));
    EXPECT_NO_THROW(folder.load(quad("[[0, 0, 0], [1e-20, 0, 0], [1e-20, 1e-20, 0], [0, 1e-20, 0]]")));
    EXPECT_NO_THROW(folder.load(quad("[[0, 0, 0], [1e6, 0, 0], [1e6, 1, 0], [0, 1, 0]]")));
    EXPECT_NO_THROW(folder.load(quad("[[0, 0, 0], [1, 0, 0.001], [1, 1, 0], [0, 1, 0]]")));
}

TEST(Geometry, RefusesBadQuads) {
    SceneFolder folder;
    const std::string no_area =
        "the quad has no area, or its sides cross; list its corners counter-clockwise";
    const std::string concave = "the quad is not convex; use a mesh, or list its corners counter-clockwise";
    folder.expect_error(quad("@[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]"), no_area);
    folder.expect_error(quad("@[[1, 1, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1]]"), no_area);
    folder.expect_error(quad("@[[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]"), no_area);
    folder.expect_error(quad("@[[0, 0, 0], [4, 1, 0], [1, 0, 0], [0, 3, 0]]"), concave);
    folder.expect_error(quad("@[[0, 0, 0], [2, 1, 0], [4, 0, 0], [2, 2, 0]]"), concave);
    folder.expect_error(quad("@[[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 2, 0]]"), concave);
    // The left wall of the Cornell box.
    folder.expect_error(quad("@[[552.8, 0, 0], [549.6, 0, 559.2], [556, 548.8, 559.2], [556, 548.8, 0]]"),
                        "the corners of the quad do not lie in a plane; use a mesh of two triangles");
    folder.expect_error(quad("@[[0, 0, 0], [1, 0, 0], [1, 1, 0]]"),
                        "\"vertices\": expected four points, found an array of 3");
    folder.expect_error(quad("[[0, 0, 0], [1, 0, 0], @[1, 1], [0, 1, 0]]"),
                        "\"vertices\": expected three numbers, found [1, 1]");
}

TEST(Geometry, BoxesHaveOutwardSides) {
    SceneFolder folder;
    const Scene scene =
        folder.load(scene_of(R"({"type": "box", "min": [-1, -2, -3], "max": [3, 2, 1], "emission": 1})"));
    ASSERT_EQ(scene.shapes.size(), 6u);
    const dvec3 center(1, 0, -1);
    dvec3 sum(0);
    for (const Shape& shape : scene.shapes) {
        const auto& c = std::get<Quad>(shape.geometry).corners;
        const dvec3 n = cross(c[1] - c[0], c[3] - c[0]);
        EXPECT_EQ(dot(n, c[0] - center), 32.0);  // 16 m^2 at a distance of 2 m.
        sum += n;
    }
    EXPECT_EQ(sum, dvec3(0));
    folder.expect_error(scene_of(R"({"type": "box", "min": [0, 0, 0], "max": @[1, 0, 1], "emission": 1})"),
                        "each number of max must be above that of min");
}

TEST(Geometry, RefusesBadMeshes) {
    SceneFolder folder;
    const std::string points = R"("positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]])";
    folder.expect_error(white_mesh(points + R"(, "triangles": [[0, 1, @3]])"),
                        "\"triangles\": expected a whole number from 0 to 2, found 3");
    folder.expect_error(white_mesh(points + R"(, "triangles": [[0, 1, @-1]])"),
                        "\"triangles\": expected a whole number from 0 to 2, found -1");
    folder.expect_error(white_mesh(points + R"(, "triangles": [@[0, 1]])"),
                        "\"triangles\": expected three indices of positions, found [0, 1]");
    folder.expect_error(white_mesh(R"("positions": @[], "triangles": [[0, 1, 2]])"),
                        "\"positions\": expected at least one point, found []");
    folder.expect_error(white_mesh(points + R"(, "triangles": [[0, 1, 2]], "normals": @[[0, 0, 1]])"),
                        "\"normals\": expected as many normals as positions, 3, found an array of 1");
    const std::string no_area = "the mesh has no triangle with an area; check its positions";
    folder.expect_error(scene_of("@{\"type\": \"mesh\", \"emission\": 1, " + points + ", \"triangles\": []}"),
                        no_area);
    folder.expect_error(
        scene_of("@{\"type\": \"mesh\", \"emission\": 1, " + points + ", \"triangles\": [[0, 0, 1]]}"),
        no_area);
}

TEST(Geometry, NormalsOfAMeshAreMadeUnit) {
    SceneFolder folder;
    const Scene scene = folder.load(white_mesh(R"("positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        "triangles": [[0, 1, 2]], "normals": [[0, 0, 1e30], [0, 3, 4], [0, 0, 0]])"));
    const TriangleMesh result = world_mesh(scene);
    const uvec3 t = result.triangles[0];
    EXPECT_EQ(result.normals[t.x], vec3(0, 0, 1));
    EXPECT_EQ(result.normals[t.y], vec3(0, 0.6f, 0.8f));
    EXPECT_EQ(result.normals[t.z], vec3(0, 0, 1));  // In the place of zero, the triangle's.
}

TEST(Geometry, AnswersForTheWholeScene) {
    SceneFolder folder;
    const Scene scene = folder.load(scene_of(
        R"({"type": "quad", "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "emission": 1},
           {"type": "mesh", "positions": [[0, 0, -3], [1, 0, 0], [0, 2, 0], [50, 50, 50]],
            "triangles": [[0, 1, 2]], "material": "white"})"));
    EXPECT_EQ(triangle_count(scene), 3u);
    EXPECT_EQ(emitter_count(scene), 1u);
    const DoubleBox box = bounds(scene);
    EXPECT_EQ(box.lo, dvec3(0, 0, -3));
    EXPECT_EQ(box.hi, dvec3(1, 2, 0));  // The unused position is ignored.
    EXPECT_TRUE(bounds(Scene()).is_empty());
    EXPECT_EQ(triangle_count(Scene()), 0u);
}

TEST(Geometry, BoundsRoundShapes) {
    Scene scene;
    scene.shapes.push_back({Sphere{dvec3(1, 2, 3), 0.5}, 0, std::nullopt});
    EXPECT_EQ(bounds(scene).lo, dvec3(0.5, 1.5, 2.5));
    EXPECT_EQ(bounds(scene).hi, dvec3(1.5, 2.5, 3.5));
    EXPECT_EQ(triangle_count(scene), 0u);

    // A disk of radius r reaches r sqrt(1 - n_i^2) along axis i. Any two radii at right angles span it.
    const glm::dvec3 n = glm::dvec3(1, 2, 2) / 3.0;
    const glm::dvec3 u = glm::dvec3(2, 1, -2) / 3.0;
    const glm::dvec3 v = cross(n, u);
    const dvec3 center(-1, 4, 0.25);
    for (const double angle : {0.0, 0.3, 1.0, 2.5}) {
        const glm::dvec3 e1 = 3.0 * (std::cos(angle) * u + std::sin(angle) * v);
        const glm::dvec3 e2 = 3.0 * (-std::sin(angle) * u + std::cos(angle) * v);
        scene.shapes = {{Disk{center, e1, e2}, 0, std::nullopt}};
        const dvec3 reach = 3.0 * sqrt(1.0 - n * n);
        // Some ten roundings of numbers below 8, each by at most 4.5e-16.
        EXPECT_LT(length(bounds(scene).lo - (center - reach)), 5e-15);
        EXPECT_LT(length(bounds(scene).hi - (center + reach)), 5e-15);
    }
    EXPECT_EQ(triangle_count(scene), 0u);
}

}  // namespace
}  // namespace candela
