// What the tests of estimators against each other share.
#pragma once

#include "render_fixture.h"

namespace candela {

// Means of an image's channels, and of its blocks of COMPARE_BLOCK squared pixels: one value per rendering,
// each with a seed of its own. These values are independent of each other, regardless of what the sampler
// does within a pixel.
struct Replicates {
    std::vector<RunningMoments> means;
    std::vector<RunningMoments> blocks;
};

// Welch's test of two sets of replicates; Sidak's correction for their number.
inline void expect_same_means(const std::vector<RunningMoments>& a, const std::vector<RunningMoments>& b) {
    ASSERT_EQ(a.size(), b.size());
    const double level = sidak_level(TEST_ALPHA, a.size());
    for (size_t i = 0; i < a.size(); ++i) {
        const double va = a[i].variance_of_mean(), vb = b[i].variance_of_mean();
        const double t = (a[i].mean() - b[i].mean()) / std::sqrt(va + vb);
        const double degrees_of_freedom =
            (va + vb) * (va + vb) / (va * va / double(a[i].count() - 1) + vb * vb / double(b[i].count() - 1));
        EXPECT_GT(student_t_p_value(t, degrees_of_freedom), level)
            << "mean " << i << ": " << a[i].mean() << ", not " << b[i].mean() << "; t = " << t;
    }
}

inline void expect_same_expectation(const Replicates& a, const Replicates& b) {
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_LE(std::sqrt(a.means[c].variance_of_mean()), largest_error() * a.means[c].mean());
        EXPECT_LE(std::sqrt(b.means[c].variance_of_mean()), largest_error() * b.means[c].mean());
    }
    expect_same_means(a.means, b.means);
    expect_same_means(a.blocks, b.blocks);
}

class EstimatorTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 64;
    static constexpr uint32_t SEEDS = 16;

    static RenderSettings settings(Estimator estimator, uint32_t seed) {
        RenderSettings s = independent_settings(SIZE, estimator, seed);
        s.max_depth = 8;
        return s;
    }
    Image image(const Scene& scene, const RenderSettings& settings, uint32_t spp) const {
        return image_of(render(scene, settings, samples(spp)));
    }
    // SEEDS renderings, the first with the seed of the settings.
    Replicates replicates(const Scene& scene, RenderSettings settings, uint32_t spp) const {
        constexpr uint32_t BLOCKS = SIZE / COMPARE_BLOCK;
        Replicates result{std::vector<RunningMoments>(3), std::vector<RunningMoments>(3 * BLOCKS * BLOCKS)};
        for (uint32_t i = 0; i < SEEDS; ++i, ++settings.seed) {
            const Image rendered = image(scene, settings, spp);
            for (size_t c = 0; c < 3; ++c) {
                result.means[c].add(image_mean(rendered, c).mean);
                std::vector<RunningMoments> blocks(BLOCKS * BLOCKS);
                for (size_t p = 0; p < rendered.pixel_count(); ++p)
                    blocks[p / SIZE / COMPARE_BLOCK * BLOCKS + p % SIZE / COMPARE_BLOCK].add(
                        double(plane(rendered, "", c)[p]));
                for (size_t b = 0; b < blocks.size(); ++b)
                    result.blocks[c * blocks.size() + b].add(blocks[b].mean());
            }
        }
        return result;
    }
    // Samples per pixel: what each estimator needs for largest_error().
    void expect_estimators_agree(const Scene& scene, uint32_t bsdf_spp, uint32_t spp,
                                 LightSampler sampler = LightSampler::tree) const {
        const auto settings = [&](Estimator estimator, uint32_t seed) {
            RenderSettings s = EstimatorTest::settings(estimator, seed);
            s.light_sampler = sampler;
            return s;
        };
        const Image mis = image(scene, settings(Estimator::mis, 1), spp);
        {
            SCOPED_TRACE("light samples only");
            expect_same_expectation(image(scene, settings(Estimator::light, 2), spp), mis);
        }
        SCOPED_TRACE("BSDF samples only");
        expect_same_expectation(image(scene, settings(Estimator::bsdf, 3), bsdf_spp), mis);
    }
};

}  // namespace candela
