// Tangents: closed forms, invariances, and triangles that tell nothing. tangents_oracle_test.cpp compares
// them with another program's.
#include "scene/tangents.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "probe/random.h"
#include "scene/mesh.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

// The tangent of a corner.
vec4 tangent_of(const TriangleMesh& mesh, size_t corner) {
    return mesh.tangents.at(vertex_of(mesh, corner));
}

TriangleMesh with_tangents(TriangleMesh mesh, uint32_t uv_set = 0) {
    add_tangents(mesh, uv_set);
    return mesh;
}

// A sheet of n x n squares over [-1, 1]^2 in the x-y plane, texture coordinates as positions.
TriangleMesh sheet(uint32_t n) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < (n + 1) * (n + 1); ++i) {
        const vec2 p = 2.0f * vec2(float(i % (n + 1)), float(i / (n + 1))) / float(n) - 1.0f;
        mesh.positions.emplace_back(p.x, p.y, 0.0f);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.uv0.push_back(p);
    }
    for (uint32_t i = 0; i < n * n; ++i) {
        const uint32_t a = i / n * (n + 1) + i % n;
        mesh.triangles.emplace_back(a, a + 1, a + n + 2);
        mesh.triangles.emplace_back(a, a + n + 2, a + n + 1);
    }
    return mesh;
}

// A bumpy sheet with smooth normals and an uneven texture, which is mirrored where x < 0.
TriangleMesh hills(Random& random) {
    TriangleMesh mesh = sheet(12);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i].z = 0.1f * random.unit();
        mesh.uv0[i] = {std::abs(mesh.uv0[i].x), mesh.uv0[i].y + 0.05f * random.unit()};
    }
    smooth_normals(mesh);
    return mesh;
}

// Every vertex has a unit tangent, orthogonal to its normal up to the rounding of floats, and a sign.
void expect_valid(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
        const dvec3 t(mesh.tangents[i]);
        ASSERT_NEAR(length(t), 1.0, 0x1p-23);
        ASSERT_EQ(std::abs(mesh.tangents[i].w), 1.0f);
        if (mesh.normals.empty() || mesh.normals[i] == vec3(0.0f)) continue;
        ASSERT_NEAR(dot(t, normalize(dvec3(mesh.normals[i]))), 0.0, 0x1p-23);
    }
}

// An affine map from plane to texture has one tangent, the direction in which u grows and v does not.
TEST(Tangents, OfAnAffineMapAreThatOfItsInverse) {
    Random random(1);
    const TriangleMesh plane = sheet(3);
    for (int i = 0; i < 100; ++i) {
        const vec2 a = 2.0f * random.square() - 1.0f;
        const vec2 b = 2.0f * random.square() - 1.0f;
        const double determinant = double(a.x) * b.y - double(a.y) * b.x;
        if (std::abs(determinant) < 0.1) continue;
        TriangleMesh mesh = plane;
        for (vec2& uv : mesh.uv0)
            uv = uv.x * a + uv.y * b;
        add_tangents(mesh);
        expect_valid(mesh);
        EXPECT_EQ(mesh.positions.size(), plane.positions.size());
        // x a + y b = (1, 0), scaled; u and v are rounded by 2^-24, which an edge of 2/3 and the determinant
        // magnify to less than 2^-24 * 4 / (2/3) / 0.1.
        const dvec3 expected = normalize(dvec3(b.y, -a.y, 0.0)) * (determinant > 0.0 ? 1.0 : -1.0);
        for (const vec4 t : mesh.tangents) {
            EXPECT_LT(length(dvec3(t) - expected), 60 * 0x1p-24);
            EXPECT_EQ(t.w, determinant > 0.0 ? 1.0f : -1.0f);
        }
    }
}

TEST(Tangents, AMirroredHalfHasANegativeSignAndVerticesOfItsOwn) {
    TriangleMesh mesh = sheet(4);
    for (vec2& uv : mesh.uv0)
        uv.x = std::abs(uv.x);
    const TriangleMesh result = with_tangents(mesh);
    EXPECT_EQ(result.positions.size(), mesh.positions.size() + 5);  // Those at x = 0.
    for (size_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
        const uvec3 t = mesh.triangles[c / 3];
        const bool mirrored = mesh.positions[t.x].x + mesh.positions[t.y].x + mesh.positions[t.z].x < 0.0f;
        EXPECT_EQ(tangent_of(result, c), mirrored ? vec4(-1, 0, 0, -1) : vec4(1, 0, 0, 1));
    }
}

// 0 and -0 are one number: the corners of the two halves are connected where x = 0.
TEST(Tangents, KnowNoSignOfZero) {
    TriangleMesh mesh = sheet(1);
    mesh.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 1, 0)};
    mesh.normals = {vec3(0, 1, 1), vec3(0, 0, 1), vec3(0, -1, 1), vec3(1, 0, 1)};
    mesh.uv0 = {vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(1, 3)};
    for (const uint32_t vertex : {0u, 3u})
        append_vertex(mesh, mesh, vertex);
    mesh.triangles = {uvec3(0, 1, 3), uvec3(4, 5, 2)};
    const std::vector<vec4> expected = with_tangents(mesh).tangents;
    EXPECT_EQ(expected[4], expected[0]);
    EXPECT_NE(expected[1], expected[0]);
    mesh.positions[4].x = mesh.normals[4].x = mesh.uv0[4].y = mesh.normals[5].y = -0.0f;
    EXPECT_EQ(with_tangents(mesh).tangents, expected);
}

// Two triangles, of 90 and 45 degrees at the vertex 0, in a plane.
TEST(Tangents, AreWeightedByAngles) {
    TriangleMesh mesh;
    mesh.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(-1, 1, 0)};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)};
    // u = x, v = y in the first one; u = 2 x, v = 2 x + y in the second one, so that v is constant along
    // (1, -2).
    mesh.uv0 = {vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(-2, -1)};
    add_tangents(mesh);
    const dvec3 expected = normalize(90.0 * dvec3(1, 0, 0) + 45.0 * normalize(dvec3(1, -2, 0)));
    EXPECT_LT(length(dvec3(mesh.tangents[0]) - expected), 0x1p-23);
}

TEST(Tangents, ByTheSecondSetOfTextureCoordinates) {
    Random random(2);
    TriangleMesh mesh = hills(random);
    const TriangleMesh first = with_tangents(mesh);
    mesh.uv1 = mesh.uv0;
    for (vec2& uv : mesh.uv0)
        uv = random.square();
    const TriangleMesh second = with_tangents(mesh, 1);
    EXPECT_EQ(second.tangents, first.tangents);
    EXPECT_EQ(second.triangles, first.triangles);
    EXPECT_NE(with_tangents(mesh).tangents, first.tangents);
}

TEST(Tangents, StayAtAnyScaleThatIsAPowerOfTwo) {
    Random random(3);
    const TriangleMesh mesh = hills(random);
    const TriangleMesh expected = with_tangents(mesh);
    for (const int exponent : {-100, -40, -3, 1, 40, 120}) {
        TriangleMesh scaled = mesh;
        for (vec3& p : scaled.positions)
            p *= std::ldexp(1.0f, exponent);
        EXPECT_EQ(with_tangents(scaled).tangents, expected.tangents) << "positions times 2^" << exponent;
    }
    for (const int exponent : {-50, -20, -1, 5, 50}) {
        TriangleMesh scaled = mesh;
        for (vec2& uv : scaled.uv0)
            uv *= std::ldexp(1.0f, exponent);
        EXPECT_EQ(with_tangents(scaled).tangents, expected.tangents) << "texture times 2^" << exponent;
    }
}

// Sums in another order differ in the last bits of doubles, and by a step of a float at most.
TEST(Tangents, DoNotDependOnTheOrderOfTriangles) {
    Random random(4);
    std::mt19937 generator(5);
    const TriangleMesh mesh = hills(random);
    const TriangleMesh expected = with_tangents(mesh);
    for (int i = 0; i < 20; ++i) {
        std::vector<uint32_t> order(mesh.triangles.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::shuffle(order, generator);
        const auto turn = glm::length_t(random.bits() % 3);
        TriangleMesh shuffled = mesh;
        for (size_t k = 0; k < order.size(); ++k) {
            const uvec3 t = mesh.triangles[order[k]];
            shuffled.triangles[k] = {t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]};
        }
        add_tangents(shuffled);
        EXPECT_EQ(shuffled.positions.size(), expected.positions.size());
        for (size_t c = 0; c < 3 * order.size(); ++c) {
            const vec4 t = tangent_of(expected, 3 * order[c / 3] + (c + turn) % 3);
            ASSERT_LT(length(dvec3(tangent_of(shuffled, c)) - dvec3(t)), 0x1p-23);
            ASSERT_EQ(tangent_of(shuffled, c).w, t.w);
        }
    }
}

// Few different numbers, so that corners, edges and triangles coincide in all ways.
TEST(Tangents, AreValidWhateverTheMeshIs) {
    Random random(6);
    const auto coarse = [&] { return floor(2.0f * random.cube() + 1.0f); };
    for (int i = 0; i < 500; ++i) {
        TriangleMesh mesh;
        for (int k = 0; k < 60; ++k) {
            mesh.positions.push_back(coarse());
            mesh.normals.push_back(coarse());
            mesh.uv0.emplace_back(coarse());
            mesh.colors.emplace_back(random.cube(), 1);
        }
        if (i % 5 == 0) mesh.normals.clear();
        for (int k = 0; k < 100; ++k)
            mesh.triangles.push_back({random.bits() % 60, random.bits() % 60, random.bits() % 60});
        const TriangleMesh result = with_tangents(mesh);
        expect_valid(result);
        EXPECT_EQ(result.normals.size(), i % 5 == 0 ? 0 : result.positions.size());
        for (size_t c = 0; c < 300; ++c) {
            ASSERT_EQ(result.positions[vertex_of(result, c)], mesh.positions[vertex_of(mesh, c)]);
            ASSERT_EQ(result.colors[vertex_of(result, c)], mesh.colors[vertex_of(mesh, c)]);
        }
    }
}

TEST(Tangents, AreValidForTexturesThatFloatsCannotMeasure) {
    Random random(7);
    const TriangleMesh mesh = hills(random);
    for (const float scale : {1e-30f, 1e25f, 3e38f, INFINITE, std::numeric_limits<float>::quiet_NaN()}) {
        TriangleMesh scaled = mesh;
        for (vec2& uv : scaled.uv0)
            uv *= scale;
        expect_valid(with_tangents(scaled));
    }
    TriangleMesh square = sheet(1);
    square.uv0 = {vec2(0, -3e38f), vec2(1, 3e38f), vec2(2, 0), vec2(5, 0)};  // Infinite edge and area.
    expect_valid(with_tangents(square));
}

// With one point of the texture everywhere nothing is known: +X, made orthogonal to the normal, unless that
// is the normal.
TEST(Tangents, PointAlongXWhereTheTextureHasNoArea) {
    Random random(8);
    TriangleMesh mesh = hills(random);
    std::ranges::fill(mesh.uv0, vec2(0.25f));
    for (vec3& n : mesh.normals)
        n = random.direction();
    mesh.normals[0] = vec3(1, 0, 0);
    mesh.normals[1] = vec3(-2, 0, 0);
    const TriangleMesh result = with_tangents(mesh);
    expect_valid(result);
    EXPECT_EQ(result.positions.size(), mesh.positions.size());
    for (size_t i = 0; i < result.tangents.size(); ++i) {
        EXPECT_EQ(result.tangents[i].w, -1.0f);
        const dvec3 n = normalize(dvec3(mesh.normals[i]));
        if (std::abs(n.x) > 0.98) continue;
        const dvec3 expected = normalize(dvec3(1, 0, 0) - n.x * n);
        EXPECT_LT(length(dvec3(result.tangents[i]) - expected), 0x1p-23);
    }
}

// A square, and a triangle at its edge and one at its corner.
TEST(Tangents, TrianglesThatTellNothingTakeOverWhatTheirNeighboursHave) {
    TriangleMesh mesh = sheet(1);
    for (vec2& uv : mesh.uv0)
        uv = {uv.y, -uv.x};
    const vec4 expected(0, 1, 0, 1);
    // Without area in the texture, beyond the edge from 1 to 3; u and v at its tip are those of vertex 1.
    mesh.positions.emplace_back(2, 0, 0);
    mesh.normals.emplace_back(0, 0, 1);
    mesh.uv0.push_back(mesh.uv0[1]);
    mesh.triangles.emplace_back(1, 4, 3);
    // Two corners in one place.
    mesh.positions.emplace_back(-3, -3, 0);
    mesh.positions.emplace_back(-3, -3, 0);
    mesh.normals.resize(7, vec3(0, 0, 1));
    mesh.uv0.resize(7, vec2(7, 9));
    mesh.triangles.emplace_back(0, 5, 6);
    const TriangleMesh result = with_tangents(mesh);
    EXPECT_EQ(result.triangles, mesh.triangles);
    for (const size_t vertex : {0u, 1u, 2u, 3u})
        EXPECT_EQ(result.tangents[vertex], expected);
    // Nobody else is there.
    for (const size_t vertex : {4u, 5u, 6u})
        EXPECT_EQ(result.tangents[vertex], vec4(1, 0, 0, -1));
}

// Between a mirrored triangle and one that is not, a triangle without area in the texture belongs to
// whichever comes first; the other one's corner has no one.
TEST(Tangents, ATriangleThatTellsNothingHasTheSignOfItsFirstNeighbour) {
    TriangleMesh mesh;
    mesh.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0.5f, -1, 0), vec3(1, 1, 0)};
    mesh.normals.assign(5, vec3(0, 0, 1));
    mesh.uv0 = {vec2(0, 0), vec2(0, 1), vec2(0, 2), vec2(-1, 0.5f), vec2(1, 1.5f)};
    const uvec3 silent(0, 1, 2);
    const uvec3 mirrored(1, 0, 3);
    const uvec3 other(2, 1, 4);
    constexpr vec4 DEFAULT(1, 0, 0, -1);

    mesh.triangles = {mirrored, silent, other};
    TriangleMesh result = with_tangents(mesh);
    EXPECT_EQ(tangent_of(result, 0).w, -1.0f);
    EXPECT_EQ(tangent_of(result, 3), tangent_of(result, 1));
    EXPECT_EQ(tangent_of(result, 4), tangent_of(result, 0));
    EXPECT_EQ(tangent_of(result, 5), DEFAULT);

    mesh.triangles = {other, silent, mirrored};
    result = with_tangents(mesh);
    EXPECT_EQ(tangent_of(result, 0).w, 1.0f);
    EXPECT_EQ(tangent_of(result, 3), DEFAULT);
    EXPECT_EQ(tangent_of(result, 4), tangent_of(result, 1));
    EXPECT_EQ(tangent_of(result, 5), tangent_of(result, 0));
}

// Each triangle of a mesh without normals has tangents in its plane, as if each corner had its normal.
TEST(Tangents, OfAMeshWithoutNormalsLieInItsTriangles) {
    Random random(9);
    TriangleMesh mesh = hills(random);
    mesh.normals.assign(mesh.positions.size(), vec3(0.0f));
    TriangleMesh explicit_normals = mesh;
    mesh.normals[0] = explicit_normals.normals[0] = vec3(0, 0, 3);
    complete_normals(explicit_normals);
    add_tangents(explicit_normals);
    const TriangleMesh partial = with_tangents(mesh);
    expect_valid(explicit_normals);
    for (size_t c = 0; c < 3 * mesh.triangles.size(); ++c)
        ASSERT_EQ(tangent_of(partial, c), tangent_of(explicit_normals, c));
    mesh.normals.clear();
    const TriangleMesh without = with_tangents(mesh);
    EXPECT_TRUE(without.normals.empty());
    for (size_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
        if (vertex_of(mesh, c) == 0) continue;
        ASSERT_EQ(tangent_of(without, c), tangent_of(explicit_normals, c));
    }
}

TEST(Tangents, OfAnEmptyMeshAndOfVerticesWithoutTriangles) {
    EXPECT_TRUE(with_tangents({}).tangents.empty());
    TriangleMesh mesh = sheet(1);
    mesh.triangles.pop_back();
    mesh.tangents.assign(4, vec4(9));
    mesh.normals[2] = vec3(5, 0, 0);
    const TriangleMesh result = with_tangents(mesh);
    expect_valid(result);
    EXPECT_EQ(result.tangents[3], vec4(1, 0, 0, 1));
    EXPECT_EQ(result.tangents[2], vec4(0, 1, 0, -1));
}

}  // namespace
}  // namespace candela
