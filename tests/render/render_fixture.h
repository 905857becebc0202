// What the tests of whole renderings share: a device, and a scene to its accumulated state in one call.
#pragma once

#include <optional>
#include <vector>

#include "base/statistics.h"
#include "gpu_scene/gpu_scene.h"
#include "image/compare.h"
#include "render/renderer.h"
#include "support/effort.h"
#include "support/scene_builders.h"
#include "vk/device.h"
#include "vk/vk_fixture.h"

namespace candela {

// What most tests' lights emit, surfaces reflect and media absorb [1/m], and the estimators that must agree.
inline constexpr vec3 RADIANCE(1, 2, 3);
inline constexpr vec3 REFLECTANCE(0.8f, 0.5f, 0.2f);
inline constexpr vec3 ABSORPTION(0.3f, 1, 2);
inline constexpr Estimator ESTIMATORS[] = {Estimator::bsdf, Estimator::light, Estimator::mis};
inline constexpr double DEGREE = M_PI / 180.0;

// Settings for a whole small picture.
inline RenderSettings settings_for(uint32_t width, uint32_t height) {
    RenderSettings settings;
    settings.size = uvec2(width, height);
    settings.crop = {0, 0, width, height};
    return settings;
}

// Settings for statistics over a square picture: the samples of all pixels are independent.
inline RenderSettings independent_settings(uint32_t size, Estimator estimator, uint32_t seed) {
    RenderSettings settings = settings_for(size, size);
    settings.estimator = estimator;
    settings.sampler = SamplerKind::independent;
    settings.seed = seed;
    return settings;
}

inline Image image_of(const Accumulation& state) {
    return make_image(state, {.variance = true}, {});
}

// Probability with which a correct renderer fails one statistical test; it fails any of the fewer than 1000
// such tests of this folder with a probability below 1 %. Seeds are fixed, so on one device a verdict stays:
// the level bounds how often a new device is accused wrongly.
inline constexpr double TEST_ALPHA = 1e-5;

// No measured standard error may be larger than this share of the mean: else the test would accept anything.
// It is four times as large where there is a sixteenth of the samples.
inline double largest_error() {
    return 0.002 * (test_effort() == Effort::quick ? 4.0 : 1.0);
}

// Red, green or blue (0, 1, 2) of a layer that the image has, row-major.
inline std::span<const float> plane(const Image& image, std::string_view layer, size_t channel) {
    return image.find_rgb(layer).value()[channel];
}

// Mean of a channel over the image, and its standard error if pixels are independent.
struct ImageMean {
    double mean = 0.0;
    double error = 0.0;
    double pixels = 0.0;
};

inline ImageMean image_mean(const Image& image, size_t channel) {
    RunningMoments moments;
    for (const float value : plane(image, "", channel))
        moments.add(value);
    double variance = 0.0;
    for (const float value : plane(image, "Variance", channel))
        variance += value;
    const double n = double(moments.count());
    return {moments.mean(), std::sqrt(variance) / n, n};
}

// Every channel of the image must have that mean, within the noise that the image measures of itself, which
// must be small. `systematic` is the share of the mean by which the expectation itself may be off.
inline void expect_mean(const Image& image, glm::dvec3 expected, double systematic) {
    for (size_t c = 0; c < 3; ++c) {
        const ImageMean m = image_mean(image, c);
        const double value = expected[int(c)];
        EXPECT_LE(m.error, largest_error() * value);
        const double beyond = std::max(0.0, std::abs(m.mean - value) - systematic * value);
        if (beyond == 0.0) continue;
        EXPECT_GT(normal_p_value(beyond / m.error), TEST_ALPHA)
            << "mean " << m.mean << ", not " << value << "; z = " << beyond / m.error;
    }
}

// Every pixel must be exactly that.
inline void expect_pixels(const Image& image, vec3 expected) {
    for (size_t c = 0; c < 3; ++c) {
        for (const float value : plane(image, "", c))
            ASSERT_EQ(value, expected[int(c)]);
    }
}

// Share of the camera rays that hit something visible, over the image.
inline double coverage(const Image& image) {
    RunningMoments moments;
    for (const float alpha : image.find("A")->values)
        moments.add(alpha);
    return moments.mean();
}

// Two images of one expectation, made with independent samples: their means must agree by Student's test of
// the pixels' differences, and those of 8 x 8 blocks within their own standard errors, which must be small.
// Pixels alone are too noisy to say much.
inline void expect_same_expectation(const Image& a, const Image& b) {
    for (size_t c = 0; c < 3; ++c) {
        RunningMoments differences;
        for (size_t i = 0; i < a.pixel_count(); ++i)
            differences.add(double(plane(a, "", c)[i]) - double(plane(b, "", c)[i]));
        const double t = differences.mean() / std::sqrt(differences.variance_of_mean());
        EXPECT_GT(student_t_p_value(t, double(differences.count() - 1)), TEST_ALPHA)
            << "means " << image_mean(a, c).mean << " and " << image_mean(b, c).mean << "; t = " << t;
        for (const Image* image : {&a, &b}) {
            const ImageMean m = image_mean(*image, c);
            EXPECT_LE(m.error, largest_error() * m.mean);
        }
    }
    const Comparison comparison = compare(a, b, {.alpha = TEST_ALPHA});
    ASSERT_TRUE(comparison.tests.has_value());
    const WorstDeviation& block = comparison.tests->block;
    EXPECT_TRUE(block.passed()) << "block at " << block.place.x0 << ' ' << block.place.y0
                                << ": z = " << block.z;
}

class RenderTest : public vk::Vk {
  protected:
    RenderTest() { device_.emplace(instance_, info_); }
    void TearDown() override {
        device_.reset();
        Vk::TearDown();
    }
    const vk::Device& device() const { return *device_; }

    // Renders `spp` samples per pixel through the scene's first camera. Every sample must be finite, and no
    // path may reach the safety limit.
    Accumulation render(const Scene& scene, const RenderSettings& settings, uint32_t spp) const {
        return render(build_gpu_scene(scene), scene.cameras.at(0), settings, spp);
    }
    Accumulation render(const GpuScene& scene, const Camera& camera, const RenderSettings& settings,
                        uint32_t spp) const {
        Renderer renderer(device(), scene, camera, settings);
        EXPECT_TRUE(renderer.render(spp, [](double) { return true; }));
        EXPECT_EQ(renderer.counters().nonfinite_samples, 0u);
        EXPECT_EQ(renderer.counters().depth_limit_hits, 0u);
        Accumulation state = renderer.download();
        EXPECT_EQ(state.total_samples(), uint64_t{spp} * state.pixel_count());
        return state;
    }

  private:
    std::optional<vk::Device> device_;
};

}  // namespace candela
