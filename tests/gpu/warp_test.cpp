// Warps: points and directions lie where they must, and are distributed as their densities say.
#include <cmath>
#include <set>

#include "base/statistics.h"
#include "gpu/device_fixture.h"
#include "selftest/random.h"

namespace candela {
namespace {

struct Item {
    vec2 u{0};
    float exponent = 1.0f;  // Of power_cosine.
    float h_max = 1.0f;     // Of the cone.
    vec3 w{0, 0, 1};        // What sees the normal,
    float alpha = 0.5f;     // and the roughness.
    uint32_t corners = 3;   // Of the polygon.
    uvec3 unused{0};
};
static_assert(sizeof(Item) == 48);

struct Result {
    vec2 disk;
    vec3 direction;
    float pdf;
    vec2 triangle;
    vec3 power_cosine, sphere, cone, normal;
    vec2 polygon;
};

class WarpTest : public DeviceTest {
  protected:
    static constexpr uint32_t CELLS = 16;  // Along each axis of a histogram.
    static constexpr size_t SAMPLES = 200000;

    std::vector<Result> run(const std::vector<Item>& items) const {
        return map<Result>(kernels::warp, items);
    }
    std::vector<Result> run_random(uint32_t seed, const Item& parameters = {}) const {
        Random random(seed);
        std::vector<Item> items(SAMPLES, parameters);
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
        return pearson_p_value(counts, std::vector<double>(counts.size(), 1.0));
    }
    // Angle around the origin as a share of a full turn.
    static double turn(double x, double y) { return std::atan2(y, x) / (2.0 * M_PI) + 0.5; }
    // 1 - cos of a unit vector's angle to +z, without cancellation around the pole.
    static double height(vec3 w) {
        const double sine_squared = double(w.x) * double(w.x) + double(w.y) * double(w.y);
        return w.z > 0.0f ? sine_squared / (1.0 + double(w.z)) : 1.0 - double(w.z);
    }
    // A point of the polygon as (sum^2, (k + b2 / sum) / corners), where it is b1 times corner k plus b2
    // times the next one and sum = b1 + b2.
    static glm::dvec2 in_polygon(vec2 p, uint32_t corners) {
        const double step = 2.0 * M_PI / corners, angle = std::atan2(double(p.y), double(p.x));
        const double k = std::floor((angle < 0.0 ? angle + 2.0 * M_PI : angle) / step);
        const glm::dvec2 c1(std::cos(k * step), std::sin(k * step));
        const glm::dvec2 c2(std::cos((k + 1.0) * step), std::sin((k + 1.0) * step));
        const double det = c1.x * c2.y - c1.y * c2.x;
        const double b1 = (double(p.x) * c2.y - double(p.y) * c2.x) / det;
        const double b2 = (c1.x * double(p.y) - c1.y * double(p.x)) / det;
        const double sum = b1 + b2;
        return {sum * sum, (k + (sum > 0.0 ? b2 / sum : 0.0)) / corners};
    }
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

// In the coordinates of the distribution function and the angle.
TEST_F(WarpTest, PowersOfTheCosineFollowTheirDensity) {
    const std::vector<float> exponents{0.0f, 1.0f, 7.5f, 100.0f, 1e4f, 1e5f};
    const double level = sidak_level(CHI_SQUARED_ALPHA, exponents.size());
    for (const float n : exponents) {
        const std::vector<Result> results = run_random(7, {.exponent = n});
        EXPECT_GT(uniformity(results,
                             [&](const Result& r) {
                                 const double h = height(r.power_cosine);
                                 return glm::dvec2(std::exp((double(n) + 1.0) * std::log1p(-h)),
                                                   turn(r.power_cosine.x, r.power_cosine.y));
                             }),
                  level)
            << n;
    }
}

// As many directions as random numbers: a cosine that was taken to a power and back would have 1 180 values.
// The numbers are 64 * 2^-24 apart, and a direction is told apart from its neighbours unless their sines
// round to one float.
TEST_F(WarpTest, NarrowLobesKeepAllTheirDirections) {
    std::vector<Item> items;
    for (uint32_t i = 0; i < 1u << 18; ++i)
        items.push_back({.u = vec2((float(i) + 0.5f) * 0x1p-18f, 0.0f), .exponent = 1e5f});
    std::set<float> sines;
    for (const Result& r : run(items))
        sines.insert(r.power_cosine.x);
    EXPECT_GT(sines.size(), items.size() * 9 / 10);
}

TEST_F(WarpTest, SphereAndConesAreUniform) {
    const std::vector<float> caps{1e-8f, 1e-3f, 0.5f, 1.0f, 2.0f};
    const double level = sidak_level(CHI_SQUARED_ALPHA, 1 + caps.size());
    for (const float h_max : caps) {
        const std::vector<Result> results = run_random(8, {.h_max = h_max});
        for (const Result& r : results) {
            ASSERT_NEAR(length(glm::dvec3(r.cone)), 1.0, 0x1p-20);
            ASSERT_LE(height(r.cone), double(h_max) * (1.0 + 0x1p-20));
        }
        EXPECT_GT(uniformity(results,
                             [&](const Result& r) {
                                 return glm::dvec2(height(r.cone) / double(h_max), turn(r.cone.x, r.cone.y));
                             }),
                  level)
            << h_max;
    }
    EXPECT_GT(uniformity(run_random(9),
                         [](const Result& r) {
                             return glm::dvec2(height(r.sphere) / 2.0, turn(r.sphere.x, r.sphere.y));
                         }),
              level);
}

// Uniform over the area, and within the sides but for some roundings; the first corner is at (1, 0).
TEST_F(WarpTest, PolygonsAreUniform) {
    const std::vector<uint32_t> polygons{3, 4, 5, 6, 64};
    const double level = sidak_level(CHI_SQUARED_ALPHA, polygons.size());
    for (const uint32_t corners : polygons) {
        const std::vector<Result> results = run_random(10, {.corners = corners});
        for (const Result& r : results)
            ASSERT_LE(in_polygon(r.polygon, corners).x, 1.0 + 0x1p-20);
        EXPECT_GT(uniformity(results, [&](const Result& r) { return in_polygon(r.polygon, corners); }), level)
            << corners;
        const float almost = (1.0f - 0x1p-20f) / float(corners);
        const vec2 first = run({{.u = vec2(almost, 0.0f), .corners = corners}})[0].polygon;
        EXPECT_LE(length(first - vec2(1, 0)), 0x1p-18f) << corners;
    }
}

// By slopes (x, y) = alpha sqrt(a / (1 - a)) (cos, sin): d(slopes) = pi alpha^2 / (1 - a)^2 da db, d(normal)
// = n.z^3 d(slopes), with 1 - a = (1 - s)^2. The density is D(n) max(0, w.n) over the projected area of all
// facets that w sees, which a sum over the cells gives as well as Smith's formula does; it is continuous, so
// that the midpoint rule is good to 10^-3.
TEST_F(WarpTest, VisibleNormalsFollowTheirDensity) {
    const std::vector<vec3> views{vec3(0, 0, 1), normalize(vec3(1, 0.5, 1)), normalize(vec3(-1, 2, 0.01))};
    const double level = sidak_level(CHI_SQUARED_ALPHA, 3 * views.size());
    for (const vec3 w : views) {
        for (const float alpha : {0.01f, 0.3f, 1.0f}) {
            constexpr uint32_t FINE = 32, ALONG = CELLS * FINE;
            std::vector<double> expected(CELLS * CELLS), counts(CELLS * CELLS);
            for (uint32_t i = 0; i < ALONG * ALONG; ++i) {
                const double t = 1.0 - (i / ALONG + 0.5) / ALONG,
                             phi = 2.0 * M_PI * ((i % ALONG + 0.5) / ALONG - 0.5);
                const double r = double(alpha) * std::sqrt(1.0 - t * t) / t;
                const glm::dvec3 n = normalize(glm::dvec3(r * std::cos(phi), r * std::sin(phi), 1.0));
                // D n.z^4 is the density of slopes, uniform in (a, b): what is left of it is 1 / n.z.
                const double share = std::max(0.0, dot(glm::dvec3(w), n)) / n.z * 2.0 * t;
                expected[i / ALONG / FINE * CELLS + i % ALONG / FINE] += share;
            }
            for (const Result& result : run_random(11, {.w = w, .alpha = alpha})) {
                const glm::dvec3 n(result.normal);
                ASSERT_NEAR(length(n), 1.0, 0x1p-20);
                ASSERT_GT(n.z, 0.0);
                const double r = std::hypot(n.x, n.y) / (double(alpha) * n.z);
                const auto cell = [](double x) {
                    return std::min(uint32_t(std::max(x, 0.0) * CELLS), CELLS - 1);
                };
                ++counts[cell(1.0 - 1.0 / std::sqrt(1.0 + r * r)) * CELLS + cell(turn(n.x, n.y))];
            }
            // Of a cell of which no point is seen from w, a sliver may be.
            for (size_t i = 0; i < counts.size(); ++i) {
                if (expected[i] > 0.0) continue;
                EXPECT_LT(counts[i], 10.0);
                counts[i] = 0.0;
            }
            EXPECT_GT(pearson_p_value(counts, expected), level) << alpha << ", cosine " << w.z;
        }
    }
}

// Random points, and the edges, corners, centre and diagonals of the square, where formulas divide by 0.
TEST_F(WarpTest, ResultsLieInTheirDomains) {
    const float last = 1.0f - 0x1p-24f;
    std::vector<Item> items;
    for (const float x : {0.0f, 0x1p-24f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, last}) {
        for (const float y : {0.0f, 0x1p-24f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, last}) {
            items.push_back({.u = vec2(x, y)});
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
        ASSERT_NEAR(length(glm::dvec3(r.power_cosine)), 1.0, 0x1p-20);
        ASSERT_NEAR(length(glm::dvec3(r.sphere)), 1.0, 0x1p-20);
        ASSERT_NEAR(length(glm::dvec3(r.cone)), 1.0, 0x1p-20);
        ASSERT_NEAR(length(glm::dvec3(r.normal)), 1.0, 0x1p-20);
        ASSERT_GE(r.triangle.x, 0.0f);
        ASSERT_GE(r.triangle.y, 0.0f);
        ASSERT_LE(double(r.triangle.x) + double(r.triangle.y), 1.0);
    }
}

}  // namespace
}  // namespace candela
