// Every BSDF that is a function: samples follow the density, weights are f cos / pdf, f is reciprocal and
// creates no energy.
#include <utility>
#include <variant>

#include "gpu/bsdf_fixture.h"
#include "selftest/charts.h"

namespace candela {
namespace {

using Chart = std::variant<SphereChart, LobeChart, FacetChart>;

// A material, seen from wo, and a chart that resolves its samples.
struct Case {
    MaterialRecord material;
    vec3 wo;
    Chart chart;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const vec3 wo : VIEWS) {
        const glm::dvec3 mirrored(-wo.x, -wo.y, wo.z);
        for (const vec3 colour : {vec3(1.0f), vec3(0.8f, 0.3f, 0.0f)})
            all.push_back({diffuse(colour), wo, SphereChart()});
        for (const vec3 kd : {vec3(0.0f), vec3(0.5f, 0.2f, 0.4f)}) {
            for (const float n : {0.0f, 1.0f, 7.5f})
                all.push_back({phong(kd, vec3(0.4f, 0.8f, 0.1f), n), wo, SphereChart()});
            for (const float n : {100.0f, 1e3f, 1e4f, 1e5f})
                all.push_back({phong(kd, vec3(0.4f, 0.8f, 0.1f), n), wo, LobeChart(mirrored, n)});
        }
        all.push_back({phong(vec3(0.7f, 0.2f, 0.0f), vec3(0.0f), 50.0f), wo, SphereChart()});
        for (const float alpha : {1e-3f, 0.01f, 0.1f, 0.5f, 1.0f})
            all.push_back({conductor(vec3(0.9f, 0.6f, 0.3f), alpha), wo, FacetChart(glm::dvec3(wo), alpha)});
    }
    return all;
}

// Cells of equal size in a chart, FINE^2 points in each.
constexpr uint32_t CELLS = 16, FINE = 20;
constexpr uint32_t ALONG = CELLS * FINE;
constexpr size_t REST = CELLS * CELLS;  // What is in no cell.

ChartPoint point_of(const Chart& chart, size_t i) {
    const double a = (double(i / ALONG) + 0.5) / ALONG, b = (double(i % ALONG) + 0.5) / ALONG;
    return std::visit([&](const auto& c) { return c.at(a, b); }, chart);
}

size_t cell_of(const Chart& chart, vec3 w) {
    const auto at = std::visit([&](const auto& c) { return c.find(glm::dvec3(w)); }, chart);
    const auto cell = [](double x) { return size_t(std::clamp(x, 0.0, 1.0 - 1e-9) * CELLS); };
    return at ? cell(at->x) * CELLS + cell(at->y) : REST;
}

class BsdfStatisticsTest : public BsdfTest {
  protected:
    // Samples of a case, and in the same items the points of its chart.
    std::vector<BsdfResult> run_case(const Case& c, uint32_t seed) const {
        Random random(seed);
        std::vector<BsdfItem> items(ALONG * ALONG, {.material = c.material, .wo = c.wo});
        for (size_t i = 0; i < items.size(); ++i) {
            items[i].wi = vec3(point_of(c.chart, i).w);
            items[i].u = random.square();
            items[i].uc = random.unit();
        }
        return run(items);
    }
};

// The density is integrated over each cell by the midpoint rule. Cells through which the horizon runs, where
// it jumps to 0, and all that the chart does not show, are one cell together with the samples that failed:
// what is left of 1.
TEST_F(BsdfStatisticsTest, SamplesFollowTheDensity) {
    const std::vector<Case> all = cases();
    const double level = sidak_level(CHI_SQUARED_ALPHA, all.size());
    for (size_t k = 0; k < all.size(); ++k) {
        const Case& c = all[k];
        SCOPED_TRACE(k);
        std::vector<double> expected(CELLS * CELLS + 1), counts(CELLS * CELLS + 1);
        std::vector<bool> above(CELLS * CELLS + 1, true);
        const std::vector<BsdfResult> results = run_case(c, uint32_t(700 + k));
        for (size_t i = 0; i < results.size(); ++i) {
            const size_t cell = i / ALONG / FINE * CELLS + i % ALONG / FINE;
            const double solid_angle = point_of(c.chart, i).solid_angle / double(results.size());
            expected[cell] += double(results[i].pdf_of_wi) * solid_angle;
            above[cell] = above[cell] && results[i].pdf_of_wi > 0.0f;
            ++counts[results[i].pdf > 0.0f ? cell_of(c.chart, results[i].wi) : REST];
        }
        expected[REST] = 1.0;
        for (size_t cell = 0; cell < REST; ++cell) {
            if (above[cell]) {
                expected[REST] -= expected[cell];
            } else {
                expected[cell] = 0.0;
                counts[REST] += std::exchange(counts[cell], 0.0);
            }
        }
        // Where nothing is left, the error of the integral is: a few times 10^-4.
        EXPECT_GE(expected[REST], -1e-3);
        if (expected[REST] < 1e-3) {
            EXPECT_LE(counts[REST], 2e-3 * double(results.size()));
            expected[REST] = counts[REST] = 0.0;
        }
        EXPECT_GT(pearson_p_value(counts, expected), level);
    }
}

// Phong: the exponent of the lobe is below 17 where it was sampled (u >= 2^-24) and has the roundings of the
// chord and of the logarithm, 12 * 2^-24 of itself: 2^-16 of the lobe. Conductor: F changes by 5 times as
// much as its cosine, which has a few roundings, so that the weight is off by 2^-19 of the whole. All else is
// some dozen roundings.
TEST_F(BsdfStatisticsTest, SampleAndEvaluationAgree) {
    const std::vector<Case> all = cases();
    for (size_t k = 0; k < all.size(); ++k) {
        SCOPED_TRACE(k);
        glm::dvec3 albedo(0.0), squares(0.0);
        const std::vector<BsdfResult> results = run_case(all[k], uint32_t(800 + k));
        for (const BsdfResult& s : results) {
            ASSERT_EQ(s.delta, 0u);
            ASSERT_EQ(s.eta, 1.0f);
            if (s.pdf == 0.0f) continue;  // It failed.
            ASSERT_NEAR(length(glm::dvec3(s.wi)), 1.0, 0x1p-20);
            ASSERT_GT(s.wi.z, 0.0f);
            ASSERT_NEAR(s.pdf, s.pdf_of_sample, double(s.pdf) * 0x1p-15);
            for (const int c : {0, 1, 2}) {
                const double weight = double(s.f_of_sample[c]) * double(s.wi.z) / double(s.pdf_of_sample);
                ASSERT_NEAR(s.weight[c], weight, weight * 0x1p-15 + 0x1p-19);
            }
            albedo += glm::dvec3(s.weight);
            squares += glm::dvec3(s.weight) * glm::dvec3(s.weight);
        }
        // No more light leaves than arrives: the mean of the weights is at most 1, within 4 of its
        // deviations.
        const auto count = double(results.size());
        for (const int c : {0, 1, 2}) {
            const double mean = albedo[c] / count;
            const double variance = (squares[c] / count - mean * mean) / count;
            EXPECT_LE(mean, 1.0 + 4.0 * std::sqrt(std::max(variance, 0.0)) + 0x1p-20);
        }
    }
}

TEST_F(BsdfTest, DiffuseWeightsAreTheReflectanceToTheBit) {
    for (const vec3 colour : {vec3(1.0f), vec3(0.8f, 0.3f, 0.0f)}) {
        for (const BsdfResult& s : samples(diffuse(colour), VIEWS[1], 10000, 9))
            ASSERT_EQ(s.weight, colour);
    }
}

TEST_F(BsdfTest, DiffuseReflectsOnlyUpwards) {
    const MaterialRecord white = diffuse(vec3(1.0f));
    const std::vector<BsdfResult> values = run({{.material = white, .wi = vec3(0, 0, 1)},
                                                {.material = white, .wi = normalize(vec3(1, 0, 1e-3f))},
                                                {.material = white, .wi = normalize(vec3(1, 0, -1e-3f))},
                                                {.material = white, .wi = vec3(0, 0, -1)}});
    for (const size_t above : {0u, 1u})
        EXPECT_FLOAT_EQ(values[above].f.x, float(1.0 / M_PI));
    for (const size_t below : {2u, 3u}) {
        EXPECT_EQ(values[below].f, vec3(0.0f));
        EXPECT_EQ(values[below].pdf_of_wi, 0.0f);
    }
}

// Pairs all over the hemisphere, and pairs near the mirrored direction. Nothing in diffuse_f and phong_f
// depends on the order but signs; conductor_f takes the Fresnel term's cosine at wi: 5 roundings of it, next
// to a reflectance of 0.3 or more.
TEST_F(BsdfTest, ReflectionIsReciprocal) {
    const std::vector<MaterialRecord> materials{
        diffuse(vec3(0.8f, 0.3f, 0.0f)),
        phong(vec3(0.5f, 0.2f, 0.4f), vec3(0.4f, 0.8f, 0.1f), 7.5f),
        phong(vec3(0.1f, 0.2f, 0.4f), vec3(0.4f, 0.8f, 0.1f), 1e5f),
        conductor(vec3(0.9f, 0.6f, 0.3f), 1e-3f),
        conductor(vec3(0.9f, 0.6f, 0.3f), 0.5f),
    };
    for (const MaterialRecord& material : materials) {
        Random random(10);
        std::vector<BsdfItem> there, back;
        for (int i = 0; i < 20000; ++i) {
            vec3 wo = random.direction(), wi = random.direction();
            wo.z = std::abs(wo.z);
            const float spread = std::exp2(-12.0f * random.unit());
            wi = i % 2 == 0 ? wi : normalize(vec3(-wo.x, -wo.y, wo.z) + spread * wi);
            wi.z = std::abs(wi.z);
            there.push_back({.material = material, .wo = wo, .wi = wi});
            back.push_back({.material = material, .wo = wi, .wi = wo});
        }
        const std::vector<BsdfResult> values = run(there);
        const std::vector<BsdfResult> reversed = run(back);
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(values[i].f, reversed[i].f);
    }
}

}  // namespace
}  // namespace candela
