// Warps: points and directions lie where they must, and are distributed as their densities say.
#include <cmath>

#include "chi_squared.h"
#include "gpu/device_fixture.h"
#include "support/reference_random.h"

namespace candela {
namespace {

class WarpTest : public DeviceTest {
  protected:
    static constexpr uint32_t CELLS = 16;  // Along each axis of a histogram.
    static constexpr size_t SAMPLES = 200000;

    struct Item {
        vec2 u;
        vec2 unused{0};
    };
    struct Result {
        vec2 disk;
        vec3 direction;
        float pdf;
        vec2 triangle;
    };
    std::vector<Result> run(const std::vector<Item>& items) const {
        return map<Result>(kernels::warp, items);
    }
    std::vector<Result> run_random(uint32_t seed) const {
        Random random(seed);
        std::vector<Item> items(SAMPLES);
        for (Item& item : items)
            item.u = random.square();
        return run(items);
    }
    // p-value of the hypothesis that coordinates(result), in [0, 1]^2, are uniform.
    template <class Coordinates>
    static double uniformity(const std::vector<Result>& results, const Coordinates& coordinates) {
        std::vector<double> counts(CELLS * CELLS);
        for (const Result& result : results) {
            const glm::dvec2 at(coordinates(result) * double(CELLS));
            const auto cell = [](double x) { return std::min(uint32_t(std::max(x, 0.0)), CELLS - 1); };
            ++counts[cell(at.x) * CELLS + cell(at.y)];
        }
        return chi_squared_p_value_of(counts, std::vector<double>(counts.size(), 1.0));
    }
    // Angle around the origin as a share of a full turn.
    static double turn(double x, double y) { return std::atan2(y, x) / (2.0 * M_PI) + 0.5; }
};

// Each warp in coordinates in which its density is uniform: r^2 and angle on the disk; cos^2 and angle on the
// hemisphere; (b1 + b2)^2 and b2 / (b1 + b2) on the triangle.
TEST_F(WarpTest, SamplesFollowTheirDensities) {
    const std::vector<Result> results = run_random(5);
    const double level = sidak_level(CHI_SQUARED_ALPHA, 3);
    EXPECT_GT(uniformity(results,
                         [](const Result& r) {
                             const glm::dvec2 d(r.disk);
                             return glm::dvec2(dot(d, d), turn(d.x, d.y));
                         }),
              level);
    EXPECT_GT(uniformity(results,
                         [](const Result& r) {
                             const glm::dvec3 w(r.direction);
                             return glm::dvec2(w.z * w.z, turn(w.x, w.y));
                         }),
              level);
    EXPECT_GT(uniformity(results,
                         [](const Result& r) {
                             const double sum = double(r.triangle.x) + double(r.triangle.y);
                             return glm::dvec2(sum * sum, sum > 0.0 ? double(r.triangle.y) / sum : 0.0);
                         }),
              level);
}

// Random points, and the edges, corners, centre and diagonals of the square, where formulas divide by 0.
TEST_F(WarpTest, ResultsLieInTheirDomains) {
    const float last = 1.0f - 0x1p-24f;
    std::vector<Item> items;
    for (const float x : {0.0f, 0x1p-24f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, last}) {
        for (const float y : {0.0f, 0x1p-24f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, last}) {
            items.push_back({vec2(x, y)});
        }
    }
    std::vector<Result> results = run(items);
    const std::vector<Result> more = run_random(6);
    results.insert(results.end(), more.begin(), more.end());
    for (const Result& r : results) {
        ASSERT_LE(length(glm::dvec2(r.disk)), 1.0 + 0x1p-21);
        ASSERT_NEAR(length(glm::dvec3(r.direction)), 1.0, 0x1p-20);
        ASSERT_GE(r.direction.z, 0.0f);
        ASSERT_NEAR(r.pdf, r.direction.z / M_PI, 0x1p-23);
        ASSERT_GE(r.triangle.x, 0.0f);
        ASSERT_GE(r.triangle.y, 0.0f);
        ASSERT_LE(double(r.triangle.x) + double(r.triangle.y), 1.0);
    }
}

}  // namespace
}  // namespace candela
