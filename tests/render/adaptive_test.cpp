// Adaptive sampling on a device: limits hold, samples go where the error is, and the expectation stays.
#include "session/adaptive.h"

#include <cmath>
#include <cstring>

#include "steady_fixture.h"

namespace candela {
namespace {

class AdaptiveTest : public SteadyTest {
  protected:
    // Renders adaptively, pass after pass, and starts anew for every seed.
    class Adaptive {
      public:
        Adaptive(const AdaptiveTest& test, const Scene& scene, const RenderSettings& settings)
            : scene_(build_gpu_scene(scene)),
              settings_(settings),
              renderer_(test.steady_renderer(scene, scene_, settings, adaptive_states(settings))) {}

        const std::vector<Accumulation>& render(uint32_t spp, uint32_t seed) {
            settings_.seed = seed;
            renderer_.states() = adaptive_states(settings_);
            uint32_t planned = 0;
            double progress = 0.0;
            for (uint32_t end = 0; end < spp;) {
                end = next_pass_end(end, spp);
                EXPECT_TRUE(render_pass(renderer_, end, planned, [&](double done) {
                    EXPECT_GE(done * end, progress);
                    EXPECT_LE(done, 1.0);
                    progress = done * end;
                    return true;
                }));
                EXPECT_NEAR(samples_per_pixel(renderer_.states()), end, 1);
            }
            return renderer_.states();
        }

      private:
        GpuScene scene_;
        RenderSettings settings_;
        SteadyRenderer renderer_;
    };
};

// A pixel that stops at its limit holds the bits of one that was never asked for more.
TEST_F(AdaptiveTest, ALimitIsWhereThePixelStops) {
    constexpr uint32_t LIMITS[] = {0, 1, 5, 12, 99};
    constexpr uint32_t SPP = 16;
    const Scene scene = cornell_box();
    RenderSettings settings = settings_for(37, 23);
    settings.aovs = true;
    settings.submission_seconds = 1e-6;
    Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings);
    Accumulation start = empty_state(settings);
    start.values.resize(start.layer_count * start.pixel_count() * 4);
    for (size_t i = 0; i < start.pixel_count(); ++i)
        start.set_limit(i, LIMITS[i % std::size(LIMITS)]);
    renderer.upload(start);
    ASSERT_TRUE(renderer.render(SPP, [](double) { return true; }));
    const Accumulation limited = renderer.download();

    for (size_t k = 0; k < std::size(LIMITS); ++k) {
        renderer.reset(build_gpu_scene(scene), scene.cameras[0], settings);
        ASSERT_TRUE(renderer.render(std::min(LIMITS[k], SPP), [](double) { return true; }));
        Accumulation plain = renderer.download();
        for (size_t i = k; i < plain.pixel_count(); i += std::size(LIMITS)) {
            ASSERT_EQ(limited.limit(i), LIMITS[k]);
            plain.set_limit(i, LIMITS[k]);
            for (uint32_t layer = 0; layer < plain.layer_count; ++layer)
                ASSERT_EQ(std::memcmp(limited.at(layer, i), plain.at(layer, i), sizeof(vec4)), 0)
                    << "pixel " << i << ", layer " << layer;
        }
    }
}

// Stopped after that many submissions, in any state and pass, and recreated from what the host held.
TEST_F(AdaptiveTest, ItGoesOnToTheSameBitsFromAnyMoment) {
    constexpr uint32_t SPP = 96;
    const Scene scene = cornell_box();
    const GpuScene gpu_scene = build_gpu_scene(scene);
    RenderSettings settings = settings_for(24, 16);
    settings.submission_seconds = 1e-6;
    uint32_t planned = 0;
    std::vector<Accumulation> states = adaptive_states(settings);
    const auto render_some = [&](int submissions) {
        SteadyRenderer renderer = steady_renderer(scene, gpu_scene, settings, std::move(states));
        bool complete = true;
        for (uint32_t end = 0; complete && end < SPP;) {
            end = next_pass_end(end, SPP);
            complete = render_pass(renderer, end, planned, [&](double) { return --submissions > 0; });
        }
        states = renderer.states();
        return complete;
    };
    ASSERT_TRUE(render_some(1 << 30));
    const Image whole = make_image(states, {.variance = true, .sample_count = true}, {});

    planned = 0;
    states = adaptive_states(settings);
    int pieces = 1;
    while (!render_some(4 + pieces))
        ++pieces;
    EXPECT_GT(pieces, 8) << "two states in each of three passes, and two more in two of them";
    const Image resumed = make_image(states, {.variance = true, .sample_count = true}, {});
    for (size_t c = 0; c < whole.channels.size(); ++c)
        EXPECT_EQ(whole.channels[c].values, resumed.channels[c].values) << whole.channels[c].name;
}

// All pixels are one point under a lamp so small that a work group's first samples find it once or twice, or
// not at all. Groups without a find get few samples, those with one get many. If those were samples of the
// same half, each find would be outvoted, and the picture too dark by a third.
TEST_F(AdaptiveTest, TheExpectationStaysThoughTheSamplesGoWhereLightWasFound) {
    constexpr uint32_t SPP = 128, SEEDS = 100;
    constexpr float RADIUS = 0.025f;
    constexpr double FORM_FACTOR = double(RADIUS) * RADIUS / (1.0 + double(RADIUS) * RADIUS);
    Scene scene = floor_seen_closely(vec3(0.8f));
    add_shape(scene, Disk{dvec3(0, 1, 0), dvec3(RADIUS, 0, 0), dvec3(0, 0, RADIUS)}, 1,
              Emission{.radiance = vec3(1.0f)});
    RenderSettings settings = independent_settings(16, Estimator::bsdf, 0);
    settings.max_depth = 1;
    Adaptive adaptive(*this, scene, settings);
    RunningMoments means;
    uint32_t min = UINT32_MAX, max = 0;
    for (uint32_t seed = 0; seed < SEEDS; ++seed) {
        const std::vector<Accumulation>& states = adaptive.render(SPP, seed);
        means.add(image_mean(make_image(states, {.variance = true}, {}), 0).mean);
        min = std::min(min, count_samples(states).min);
        max = std::max(max, count_samples(states).max);
    }
    EXPECT_LT(min, SPP / 2) << "all pixels get the same, and nothing is tested";
    EXPECT_GT(max, 3 * SPP / 2);
    const double error = std::sqrt(means.variance_of_mean());
    EXPECT_LT(error, 0.04 * means.mean());
    const double t = (means.mean() - 0.8 * FORM_FACTOR) / error;
    EXPECT_GT(student_t_p_value(t, SEEDS - 1), TEST_ALPHA)
        << "mean " << means.mean() << ", not " << 0.8 * FORM_FACTOR << "; t = " << t;
}

// The mean of renderings with many seeds, whose deviations from it tell its variance.
TEST_F(AdaptiveTest, TheMeansAreThoseOfUniformSampling) {
    constexpr uint32_t SIZE = 32, SPP = 64;
    const uint32_t seeds = std::max(samples(50), 16u);  // Fewer would not tell the variance.
    const Scene scene = cornell_box();
    const RenderSettings settings = independent_settings(SIZE, Estimator::mis, 1);
    Adaptive adaptive(*this, scene, settings);
    std::vector<RunningMoments> moments(size_t{3} * SIZE * SIZE);
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        const Image image = make_image(adaptive.render(SPP, 1000 + seed), {}, {});
        for (size_t c = 0; c < 3; ++c) {
            for (size_t i = 0; i < image.pixel_count(); ++i)
                moments[c * image.pixel_count() + i].add(plane(image, "", c)[i]);
        }
    }
    Image mean{.full = settings.size, .data = settings.crop, .channels = {}, .attributes = {}};
    for (size_t c = 0; c < 3; ++c) {
        const auto add = [&](const std::string& name, const auto& value) {
            std::vector<float>& values = mean.add(name).values;
            for (size_t i = 0; i < values.size(); ++i)
                values[i] = float(value(moments[c * values.size() + i]));
        };
        add(std::string(1, "RGB"[c]), [](const RunningMoments& pixel) { return pixel.mean(); });
        add(std::string("Variance.") + "RGB"[c],
            [](const RunningMoments& pixel) { return pixel.variance_of_mean(); });
    }
    expect_same_expectation(mean, image_of(render(scene, settings, SPP * seeds)));
}

}  // namespace
}  // namespace candela
