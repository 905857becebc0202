// A closed box that emits and reflects has a closed form: L = 1 + a + a^2 + ... = 1 / (1 - a) along every
// ray. Light samples alone are left out: where walls meet, their variance is infinite, and no test means
// anything.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

class FurnaceTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 64;

    static RenderSettings settings(Estimator estimator, uint32_t seed) {
        return independent_settings(SIZE, estimator, seed);
    }
    // Student's test over the pixels, whose samples are independent of each other. Every vertex of a path
    // rounds its radiance and throughput some ten times, always the same way at worst: 2^-20 of the sum.
    void expect_mean(const Accumulation& state, double expected) const {
        const Image image = image_of(state);
        for (size_t c = 0; c < 3; ++c) {
            RunningMoments pixels;
            for (const float value : plane(image, "", c))
                pixels.add(value);
            const double error = std::sqrt(pixels.variance_of_mean());
            EXPECT_LE(error, largest_error() * expected);
            const double beyond_rounding =
                std::max(0.0, std::abs(pixels.mean() - expected) - 0x1p-20 * expected);
            if (beyond_rounding == 0.0) continue;
            const double t = beyond_rounding / error;
            EXPECT_GT(student_t_p_value(t, double(pixels.count() - 1)), TEST_ALPHA)
                << "mean " << pixels.mean() << ", not " << expected << "; t = " << t;
        }
    }
};

TEST_F(FurnaceTest, EveryRaySeesTheGeometricSeries) {
    uint32_t seed = 0;
    for (const float albedo : {0.0f, 0.5f, 0.8f, 0.95f}) {
        for (const Estimator estimator : {Estimator::bsdf, Estimator::mis}) {
            SCOPED_TRACE(testing::Message() << "albedo " << albedo << ", estimator " << int(estimator));
            expect_mean(render(furnace(albedo), settings(estimator, seed++), samples(128)),
                        1.0 / (1.0 - double(albedo)));
        }
    }
}

// Emission hit by the ray that leaves vertex D is still included: D + 1 terms.
TEST_F(FurnaceTest, MaxDepthTruncatesTheSeries) {
    uint32_t seed = 20;
    for (const uint32_t depth : {0u, 1u, 2u, 5u}) {
        for (const Estimator estimator : {Estimator::bsdf, Estimator::mis}) {
            SCOPED_TRACE(testing::Message() << "max depth " << depth << ", estimator " << int(estimator));
            RenderSettings s = settings(estimator, seed++);
            s.max_depth = depth;
            expect_mean(render(furnace(0.8f), s, samples(128)), (1.0 - std::pow(0.8, depth + 1.0)) / 0.2);
        }
    }
}

// Without roulette and light samples every sample is the same number: an error in any vertex shows at full
// size.
TEST_F(FurnaceTest, BsdfSamplesHaveNoVariance) {
    RenderSettings s = settings(Estimator::bsdf, 1);
    s.max_depth = 7;
    s.rr_depth = DEPTH_SAFETY_LIMIT;
    const Accumulation state = render(furnace(0.5f), s, 4);
    const float expected = 2.0f - 0x1p-7f;  // Sum of 2^-k, k = 0 .. 7: exact in floats.
    const Image image = image_of(state);
    for (const size_t c : {0u, 1u, 2u}) {
        for (const float value : plane(image, "", c))
            ASSERT_EQ(value, expected);
    }
}

// Paths that never end are cut at the safety limit and counted; up to there, nothing is lost.
TEST_F(FurnaceTest, TheSafetyLimitIsCounted) {
    RenderSettings s = settings(Estimator::bsdf, 2);
    s.size = uvec2(8, 4);
    s.crop = {0, 0, 8, 4};
    s.rr_depth = DEPTH_SAFETY_LIMIT;
    const Scene scene = furnace(1.0f);
    Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], s);
    renderer.render(1, [](double) { return true; });
    EXPECT_EQ(renderer.counters().depth_limit_hits, 32u);
    EXPECT_EQ(renderer.counters().nonfinite_samples, 0u);
    EXPECT_EQ(renderer.counters().rays, 32u * (DEPTH_SAFETY_LIMIT + 1));
    const Image image = image_of(renderer.download());
    for (const float value : plane(image, "", 0))
        ASSERT_EQ(value, float(DEPTH_SAFETY_LIMIT + 1));
}

}  // namespace
}  // namespace candela
