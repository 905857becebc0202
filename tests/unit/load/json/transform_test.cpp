// Transforms of shapes: order of steps, exactness, mirrors, and what is refused.
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "load/json/transforms.h"
#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

Transform parse_transform(const std::string& text) {
    const json::Document document{"t.json", json::parse(text, "t.json")};
    return read_transform(Node(document, "transform", document.root));
}

void expect_transform_error(std::string text, const std::string& message) {
    SCOPED_TRACE(text);
    const std::string place = take_mark(text);
    EXPECT_EQ(error_of([&] { parse_transform(text); }), "t.json:" + place + ": " + message);
}

void expect_point(const Transform& transform, glm::dvec3 p, glm::dvec3 expected) {
    EXPECT_LT(length(transform.point(p) - expected), 1e-12);
}

TEST(Transform, AppliesStepsInOrder) {
    expect_point(parse_transform("[]"), {1, 2, 3}, {1, 2, 3});
    expect_point(parse_transform(R"([{"translate": [1, 0, 0]}, {"scale": 2}])"), {1, 1, 1}, {4, 2, 2});
    expect_point(parse_transform(R"([{"scale": [2, 3, 4]}, {"translate": [1, 0, 0]}])"), {1, 1, 1},
                 {3, 3, 4});
    expect_point(parse_transform(R"([{"rotate": 90, "axis": [0, 5, 0]}, {"translate": [0, 0, 1]}])"),
                 {1, 0, 0}, {0, 0, 0});
    expect_point(parse_transform(R"([{"matrix": [1, 2, 0, 3, 0, 1, 0, 4, 0, 0, 1, 5, 0, 0, 0, 1]}])"),
                 {1, 1, 1}, {6, 5, 6});
}

TEST(Transform, KeepsNormalsPerpendicular) {
    const Transform shear = parse_transform(R"([{"scale": [1, 1, -1]}, {"rotate": 30, "axis": [1, 2, 3]},
        {"matrix": [1, 0.5, 0, 0, 0, 2, 0.25, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])");
    const glm::dvec3 u(1, 2, -1);
    const glm::dvec3 v(0, 1, 3);
    const glm::dvec3 origin = shear.point(glm::dvec3(0));
    const glm::dvec3 n(shear.normal(vec3(cross(u, v))));
    EXPECT_NEAR(length(n), 1.0, 1e-6);
    EXPECT_NEAR(dot(n, shear.point(u) - origin), 0.0, 1e-6);
    EXPECT_NEAR(dot(n, shear.point(v) - origin), 0.0, 1e-6);
    // What points away from a solid still does.
    EXPECT_GT(dot(n, shear.point(cross(u, v)) - origin), 0.0);
    EXPECT_EQ(shear.normal(vec3(0)), vec3(0));
}

TEST(Transform, KnowsMirrors) {
    EXPECT_TRUE(parse_transform(R"([{"scale": [1, -1, 1]}])").mirrors());
    EXPECT_TRUE(parse_transform(R"([{"scale": -1}])").mirrors());
    EXPECT_FALSE(parse_transform(R"([{"scale": [-1, -1, 1]}])").mirrors());
    EXPECT_FALSE(parse_transform(R"([{"scale": -1}, {"scale": -1}])").mirrors());
}

TEST(Transform, MovesVectorsByDifferences) {
    const Transform transform = parse_transform(R"([{"scale": [2, -1, 3]}, {"translate": [5, 5, 5]},
        {"rotate": 40, "axis": [1, 2, 3]}])");
    const glm::dvec3 p(1, 2, 3);
    const glm::dvec3 v(-4, 0.5, 2);
    EXPECT_LT(length(transform.vector(v) - (transform.point(p + v) - transform.point(p))), 1e-12);
}

TEST(Transform, KnowsWhatKeepsSpheres) {
    const auto scale = [](const std::string& text) { return parse_transform(text).uniform_scale(); };
    EXPECT_EQ(scale("[]"), 1.0);
    EXPECT_EQ(scale(R"([{"translate": [1e6, 0, 3]}])"), 1.0);
    EXPECT_EQ(scale(R"([{"scale": [2, -2, 2]}])"), 2.0);
    EXPECT_NEAR(scale(R"([{"rotate": 77, "axis": [3, 1, 2]}, {"scale": -0.5}])").value(), 0.5, 1e-15);
    EXPECT_NEAR(scale(R"([{"scale": 1e-30}])").value(), 1e-30, 1e-45);
    EXPECT_NEAR(scale(R"([{"scale": 1e30}])").value(), 1e30, 1e15);
    // Uneven steps that cancel out: only the whole matters.
    EXPECT_EQ(scale(R"([{"scale": [1, 2, 4]}, {"scale": [4, 2, 1]}])"), 4.0);

    EXPECT_FALSE(scale(R"([{"scale": [1, 1, 2]}])"));
    EXPECT_FALSE(scale(R"([{"scale": [1e-3, 1e-3, 1.1e-3]}])"));
    EXPECT_FALSE(scale(R"([{"rotate": 45, "axis": [0, 0, 1]}, {"scale": [1, 2, 1]}])"));
    EXPECT_FALSE(scale(R"([{"matrix": [1, 0, 0.001, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])"));
    EXPECT_FALSE(scale(R"([{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, -0.001, 0, 1, 0, 0, 0, 0, 1]}])"));
    // Squares of 1, 1 and (1 + e) differ from their mean by 4/3 e at most.
    EXPECT_TRUE(scale(R"([{"scale": [1, 1, 1.000007]}])"));
    EXPECT_FALSE(scale(R"([{"scale": [1, 1, 1.000008]}])"));
}

// Every rotation is recognised as one after its matrix is rounded to six decimals, as other programs write
// it.
TEST(Transform, KeepsSpheresUnderRoundedRotations) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 axis(uniform(random), uniform(random), uniform(random));
        const glm::dmat4 rotation = glm::rotate(glm::dmat4(1.0), 4.0 * uniform(random), normalize(axis));
        glm::dmat4 written;
        for (int column = 0; column < 4; ++column)
            written[column] = round(rotation[column] * 1e6) / 1e6;
        Transform transform;
        ASSERT_TRUE(transform.append(written));
        ASSERT_TRUE(transform.uniform_scale().has_value());
        // The mean of three squares, each off by at most 1.7e-6, halved by the root.
        ASSERT_NEAR(*transform.uniform_scale(), 1.0, 1e-6);
    }
}

TEST(Transform, HasAMeanScale) {
    const auto scale = [](const std::string& text) { return parse_transform(text).mean_scale(); };
    EXPECT_EQ(scale("[]"), 1.0);
    EXPECT_EQ(scale(R"([{"translate": [1e6, 0, 3]}, {"scale": -0.25}])"), 0.25);
    EXPECT_NEAR(scale(R"([{"scale": [-1, 2, 4]}, {"rotate": 30, "axis": [1, 2, 3]}])"), 2.0, 1e-15);
}

TEST(Transform, RefusesSingularOnes) {
    const std::string singular =
        "the transform is singular: up to this step it flattens the shape; use factors other than 0";
    expect_transform_error(R"([{"translate": [1, 1, 1]}, @{"scale": 0}])", singular);
    expect_transform_error(R"([@{"scale": [1, 0, 1]}])", singular);
    expect_transform_error(R"([@{"matrix": [1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])", singular);
    expect_transform_error(R"([{"scale": 1e-38}, {"scale": 1e-38}, @{"scale": 1e-38}, {"scale": 1e-38}])",
                           singular);
    EXPECT_NO_THROW(parse_transform(R"([{"scale": [1e-9, 1, 1e9]}])"));
}

TEST(Transform, RefusesMalformedSteps) {
    const std::string one_step =
        "a step of a transform has exactly one of the keys scale, rotate (with axis), translate and matrix";
    expect_transform_error("@{}", "\"transform\": expected an array [ ... ], found an object");
    expect_transform_error("[@{}]", one_step);
    expect_transform_error(R"([@{"axis": [1, 0, 0]}])", one_step);
    expect_transform_error(R"([@{"rotate": 90}])", one_step);
    expect_transform_error(R"([@{"scale": 2, "translate": [1, 0, 0]}])", one_step);
    expect_transform_error(
        R"([{@"scal": 2}])",
        "unknown key \"scal\" (did you mean \"scale\"? known: scale, rotate, axis, translate, matrix)");
    expect_transform_error(R"([{"rotate": 90, "axis": @[0, 0, 0]}])",
                           "\"axis\": expected a direction, not zero, found [0, 0, 0]");
    expect_transform_error(R"([{"rotate": @"90", "axis": [0, 0, 1]}])",
                           "\"rotate\": expected a number, found \"90\"");
    expect_transform_error(R"([{"matrix": @[1, 0, 0, 1]}])",
                           "\"matrix\": expected 16 numbers, row by row, found [1, 0, 0, 1]");
    expect_transform_error(R"([{"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, @0, 0, 0, 2]}])",
                           "the last row of a matrix must be 0, 0, 0, 1: the transform must be affine");
}

TEST(Transform, IsBakedInDoublePrecision) {
    SceneFolder folder;
    const Scene scene = folder.load(scene_of(R"({"type": "mesh", "material": "white",
        "positions": [[552.8, 0, 0], [549.6, 0, 559.2], [556, 548.8, 559.2]], "triangles": [[0, 1, 2]],
        "transform": [{"scale": 0.001}]})"));
    const TriangleMesh mesh = world_mesh(scene);
    // Rounded twice: half a unit in the last place of 552.8, scaled, and of 0.5528.
    constexpr float ROUNDING = 0.001f * 0x1p-15f + 0x1p-25f;
    EXPECT_NEAR(length(mesh.positions[0] - vec3(0.5528f, 0, 0)), 0.0f, 2 * ROUNDING);
    EXPECT_NEAR(length(mesh.positions[1] - vec3(0.5496f, 0, 0.5592f)), 0.0f, 2 * ROUNDING);
    EXPECT_NEAR(length(mesh.positions[2] - vec3(0.556f, 0.5488f, 0.5592f)), 0.0f, 2 * ROUNDING);
}

// The fronts of all shapes face away from the middle, mirrored or not.
TEST(Transform, KeepsFrontsInFront) {
    SceneFolder folder;
    const std::string octant = R"("positions": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 1, 2]],
        "normals": [[2, 0.5, 0.5], [0.5, 2, 0.5], [0.5, 0.5, 2]])";
    const std::string quad = R"("vertices": [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])";
    folder.write("t.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
    for (const char* scale : {"[1, 2, 3]", "[-1, 2, 3]", "[-1, -2, -3]", "[1, -2, -3]"}) {
        const std::string rest =
            R"(, "material": "white", "transform": [{"scale": )" + std::string(scale) + "}]}";
        const Scene scene = folder.load(
            scene_of(R"({"type": "box", "min": [-1, -1, -1], "max": [1, 1, 1])" + rest +
                     ", {\"type\": \"mesh\", " + octant + rest + ", {\"type\": \"quad\", " + quad + rest +
                     R"(, {"type": "obj", "file": "t.obj", "normals": "smooth")" + rest));
        ASSERT_EQ(scene.shapes.size(), 9u);
        for (size_t shape = 0; shape < scene.shapes.size(); ++shape) {
            if (const auto* q = std::get_if<Quad>(&scene.shapes[shape].geometry)) {
                const dvec3 n = cross(q->corners[1] - q->corners[0], q->corners[2] - q->corners[0]);
                EXPECT_GT(dot(n, q->corners[0]), 0.0);
                continue;
            }
            const TriangleMesh mesh = world_mesh(scene, shape);
            const uvec3 t = mesh.triangles[0];
            const vec3 p = mesh.positions[t.x];
            const vec3 n = cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p);
            EXPECT_GT(dot(n, p), 0.0f);
            for (const vec3 normal : mesh.normals)
                EXPECT_GT(dot(n, normal), 0.0f);
        }
    }
}

}  // namespace
}  // namespace candela
