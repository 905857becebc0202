// Pairing: every triangle once, corners in the order of both triangles, and no pair that is worse than two
// alone.
#include "gpu_scene/triangle_pairs.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "probe/scenes.h"

namespace candela {
namespace {

// Whether a b c are the corners of that triangle, in its order, starting with any of them.
bool same_triangle(uvec3 t, uint a, uint b, uint c) {
    const uvec3 corners(a, b, c);
    return corners == t || corners == uvec3(t.y, t.z, t.x) || corners == uvec3(t.z, t.x, t.y);
}

// n x n squares of two triangles each.
TriangleMesh grid(uint n) {
    TriangleMesh mesh;
    for (uint y = 0; y <= n; ++y) {
        for (uint x = 0; x <= n; ++x)
            mesh.positions.emplace_back(float(x), float(y), 0.1f * float(x * y % 3));
    }
    for (uint y = 0; y < n; ++y) {
        for (uint x = 0; x < n; ++x) {
            const uint i = y * (n + 1) + x;
            mesh.triangles.emplace_back(i, i + 1, i + n + 2);
            mesh.triangles.emplace_back(i, i + n + 2, i + n + 1);
        }
    }
    return mesh;
}

void expect_each_triangle_once(const TriangleMesh& mesh, const std::vector<TrianglePair>& pairs) {
    std::set<uint32_t> seen;
    for (const auto& [v, first, second] : pairs) {
        EXPECT_TRUE(seen.insert(first).second) << first;
        EXPECT_TRUE(same_triangle(mesh.triangles[first], v.x, v.y, v.z)) << first;
        if (second == first) {
            EXPECT_EQ(v.w, v.z);
            continue;
        }
        EXPECT_GT(second, first);
        EXPECT_TRUE(seen.insert(second).second) << second;
        EXPECT_TRUE(same_triangle(mesh.triangles[second], v.x, v.z, v.w)) << second;
    }
    EXPECT_EQ(seen.size(), mesh.triangles.size());
    EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end(),
                               [](const auto& a, const auto& b) { return a.first < b.first; }));
}

TEST(TrianglePairs, EveryTriangleIsThereOnce) {
    for (const TriangleMesh& mesh :
         {grid(9), sphere_mesh(12, 17), triangle_soup(100, 0.3f, 1), TriangleMesh{}}) {
        expect_each_triangle_once(mesh, pair_triangles(mesh));
        expect_each_triangle_once(mesh, single_triangles(mesh));
        EXPECT_EQ(single_triangles(mesh).size(), mesh.triangles.size());
    }
}

TEST(TrianglePairs, SquaresArePairedWhereverTheirTrianglesStand) {
    TriangleMesh mesh = grid(20);
    EXPECT_EQ(pair_triangles(mesh).size(), 400u);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(1));
    const std::vector<TrianglePair> pairs = pair_triangles(mesh);
    expect_each_triangle_once(mesh, pairs);
    // Some triangles find their best partners taken; the box of a square saves the most.
    EXPECT_LT(pairs.size(), 440u);
}

TEST(TrianglePairs, TheLargestSavingWins) {
    // Triangle 0 touches 1 and 2; with 2 it is a unit square.
    const TriangleMesh mesh{
        .positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(2, -1, 0), vec3(0, 1, 0)},
        .normals = {},
        .triangles = {uvec3(0, 1, 2), uvec3(1, 0, 3), uvec3(0, 2, 4)}};
    const std::vector<TrianglePair> pairs = pair_triangles(mesh);
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs[0].second, 2u);
    EXPECT_EQ(pairs[0].corners, uvec4(0, 1, 2, 4));
    EXPECT_EQ(pairs[1].second, pairs[1].first);
}

// Two pages of a book, open at a right angle: half the surface of the box is 10 m^2 for each, 120 m^2 for
// both.
TEST(TrianglePairs, ABoxThatIsLargerThanBothKeepsThemApart) {
    const TriangleMesh mesh{.positions = {vec3(0, 0, 0), vec3(0, 0, 1), vec3(10, 0, 0), vec3(0, 10, 0)},
                            .normals = {},
                            .triangles = {uvec3(0, 1, 2), uvec3(1, 0, 3)}};
    EXPECT_EQ(pair_triangles(mesh).size(), 2u);
}

TEST(TrianglePairs, OppositeWindingsStayApart) {
    const TriangleMesh mesh{.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)},
                            .normals = {},
                            .triangles = {uvec3(0, 1, 2), uvec3(0, 3, 2)}};
    EXPECT_EQ(pair_triangles(mesh).size(), 2u);
}

// To look at all of them for each would take minutes.
TEST(TrianglePairs, OfAHundredThousandTrianglesAroundAVertexTakeNoTime) {
    constexpr uint32_t MANY = 100'000;
    TriangleMesh mesh{.positions = {vec3(0.0f)}};
    for (uint32_t i = 0; i <= MANY; ++i) {
        const float angle = 1.5f * float(i) / float(MANY);
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0f);
        if (i > 0) mesh.triangles.emplace_back(0, i, i + 1);
    }
    std::vector<int> uses(MANY);
    for (const TrianglePair& pair : pair_triangles(mesh)) {
        ++uses[pair.first];
        if (pair.second != pair.first) ++uses[pair.second];
    }
    EXPECT_EQ(std::ranges::count(uses, 1), MANY);
}

}  // namespace
}  // namespace candela
