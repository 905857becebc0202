// Warps: points and directions lie where they must, and are distributed as their densities say.
#include <cmath>
#include <set>

#include "gpu/device_fixture.h"
#include "selftest/warps.h"

namespace candela {
namespace {

class WarpTest : public DeviceTest {
  protected:
    std::vector<WarpResult> run(const std::vector<WarpItem>& items) const {
        return map<WarpResult>(kernels::warp, items);
    }
};

TEST_F(WarpTest, SamplesFollowTheirDensities) {
    expect_holds(test_basic_warps(device()));
}

TEST_F(WarpTest, PowersOfTheCosineFollowTheirDensity) {
    expect_holds(test_power_cosines(device()));
}

// There are as many directions as random numbers: a cosine that was raised to a power and back would have 1
// 180 values. The numbers are 64 * 2^-24 apart, and a direction differs from its neighbours unless their
// sines round to one float.
TEST_F(WarpTest, NarrowLobesKeepAllTheirDirections) {
    std::vector<WarpItem> items;
    for (uint32_t i = 0; i < 1u << 18; ++i)
        items.push_back({.u = vec2((float(i) + 0.5f) * 0x1p-18f, 0.0f), .exponent = 1e5f});
    std::set<float> sines;
    for (const WarpResult& r : run(items))
        sines.insert(r.power_cosine.x);
    EXPECT_GT(sines.size(), items.size() * 9 / 10);
}

TEST_F(WarpTest, SphereAndConesAreUniform) {
    expect_holds(test_sphere_and_cones(device()));
}

TEST_F(WarpTest, PolygonsAreUniform) {
    expect_holds(test_polygons(device()));
}

// Up to some rounding errors.
TEST_F(WarpTest, TheFirstCornerOfAPolygonIsOnTheXAxis) {
    for (const uint32_t corners : {3u, 4u, 5u, 6u, 64u}) {
        const float almost = (1.0f - 0x1p-20f) / float(corners);
        const vec2 first = run({{.u = vec2(almost, 0.0f), .corners = corners}})[0].polygon;
        EXPECT_LE(length(first - vec2(1, 0)), 0x1p-18f) << corners;
    }
}

TEST_F(WarpTest, FiltersOfPixelsFollowTheirDensities) {
    expect_holds(test_pixel_filters(device()));
}

// Per axis, in squared halves of the width: 1/6 of a tent; of a gaussian with the standard deviation 1/3 that
// ends at 3 of these, 1/9 (1 - 9/2 e^-4.5 / (1 - e^-4.5)); of Blackman and Harris, 1/3 + 2 / pi^2 times the
// sum of (-1)^k b_k / k^2. The mean of n squares is off by the standard deviation of a square over sqrt(n),
// which is at most sqrt(2) times their mean, as of normal numbers: none of these filters has longer tails.
TEST_F(WarpTest, FiltersOfPixelsHaveTheirVariances) {
    const std::vector<WarpResult> results = run_warps(device(), 13);
    const auto expect_variance = [&](vec2 WarpResult::*place, double expected) {
        glm::dvec2 mean(0), square(0);
        for (const WarpResult& r : results) {
            const glm::dvec2 p(r.*place);
            mean += p / double(results.size());
            square += p * p / double(results.size());
        }
        for (const glm::length_t axis : {0, 1}) {
            const double error = std::sqrt(2.0 / double(results.size())) * expected;
            EXPECT_NEAR(square[axis], expected, 5.0 * error);
            EXPECT_NEAR(mean[axis], 0.0, 5.0 * std::sqrt(expected / double(results.size())));
        }
    };
    expect_variance(&WarpResult::tent, 1.0 / 6.0);
    expect_variance(&WarpResult::gaussian, (1.0 + 4.5 * std::exp(-4.5) / std::expm1(-4.5)) / 9.0);
    const double sum = (-0.48829 + 0.14128 / 4.0 - 0.01168 / 9.0) / 0.35875;
    expect_variance(&WarpResult::blackman_harris, 1.0 / 3.0 + 2.0 / (M_PI * M_PI) * sum);
}

TEST_F(WarpTest, VisibleNormalsFollowTheirDensity) {
    expect_holds(test_visible_normals(device()));
}

// Random points, and the edges, corners, centre and diagonals of the square, where formulas divide by 0.
TEST_F(WarpTest, ResultsLieInTheirDomains) {
    const float last = 1.0f - 0x1p-24f;
    std::vector<WarpItem> items;
    for (const float x : {0.0f, 0x1p-24f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, last}) {
        for (const float y : {0.0f, 0x1p-24f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, last}) {
            items.push_back({.u = vec2(x, y)});
        }
    }
    std::vector<WarpResult> results = run(items);
    const std::vector<WarpResult> more = run_warps(device(), 6);
    results.insert(results.end(), more.begin(), more.end());
    for (const WarpResult& r : results) {
        ASSERT_LE(length(glm::dvec2(r.disk)), 1.0 + 0x1p-21);
        ASSERT_NEAR(length(glm::dvec3(r.direction)), 1.0, 0x1p-20);
        ASSERT_GE(r.direction.z, 0.0f);
        ASSERT_NEAR(r.pdf, r.direction.z / M_PI, 0x1p-23);
        ASSERT_NEAR(length(glm::dvec3(r.power_cosine)), 1.0, 0x1p-20);
        ASSERT_NEAR(length(glm::dvec3(r.sphere)), 1.0, 0x1p-20);
        ASSERT_NEAR(length(glm::dvec3(r.cone)), 1.0, 0x1p-20);
        ASSERT_NEAR(length(glm::dvec3(r.normal)), 1.0, 0x1p-20);
        for (const vec2 place : {r.tent, r.gaussian, r.blackman_harris})
            ASSERT_LE(std::max(std::abs(place.x), std::abs(place.y)), 1.0f + 0x1p-20f);
        ASSERT_GE(r.triangle.x, 0.0f);
        ASSERT_GE(r.triangle.y, 0.0f);
        ASSERT_LE(double(r.triangle.x) + double(r.triangle.y), 1.0);
    }
}

}  // namespace
}  // namespace candela
