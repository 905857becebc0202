// Albedo without its noise: how little remains, and what must not change.
#include "denoise/smooth_albedo.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "denoise/level.h"

namespace candela {
namespace {

constexpr uint32_t WIDTH = 90, HEIGHT = 70;
constexpr PixelRect PICTURE{0, 0, WIDTH, HEIGHT};
constexpr float SIGMA = 0.05f;  // Of each channel.
constexpr float VARIANCE = 3.0f * SIGMA * SIGMA;

struct Owned {
    std::array<std::vector<float>, 3> albedo;
    std::vector<float> variance = std::vector<float>(size_t{WIDTH} * HEIGHT, VARIANCE);

    // Noise on that truth.
    explicit Owned(const std::function<float(uint32_t)>& truth) {
        std::mt19937 random(1);
        std::normal_distribution<float> normal(0.0f, SIGMA);
        for (std::vector<float>& plane : albedo) {
            for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i)
                plane.push_back(truth(i % WIDTH) + normal(random));
        }
    }
    NoisyPicture picture() const {
        const RgbPlanes planes{albedo[0], albedo[1], albedo[2]};
        return {.size = {WIDTH, HEIGHT}, .rgb = planes, .albedo = planes, .albedo_variance = variance};
    }
};

double mean_square(const std::vector<vec3>& values, const std::function<float(uint32_t)>& truth) {
    double sum = 0.0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i)
        sum += double(glm::dot(values[i] - truth(i % WIDTH), values[i] - truth(i % WIDTH)));
    return sum / (WIDTH * HEIGHT);
}

// The variances explain all differences: but for chance, the weights of 25 pixels are equal. Were they half
// on average, with the pixel's own 1, the variance would be less than a tenth.
TEST(SmoothAlbedo, OfNoiseLittleRemains) {
    const auto truth = [](uint32_t) { return 0.5f; };
    const Owned owned(truth);
    const double before = mean_square(
        smooth_albedo({.size = {WIDTH, HEIGHT}, .rgb = {}, .albedo = owned.picture().albedo}, PICTURE),
        truth);
    EXPECT_NEAR(before, double(VARIANCE), 0.05 * double(VARIANCE));
    EXPECT_LT(mean_square(smooth_albedo(owned.picture(), PICTURE), truth), 0.1 * before);
}

// Columns alternate by d in each channel: the square of the difference, 3 d^2, is less than the variances of
// two pixels together. All weights are 1, and the mean is that of three of the five columns and of the other
// two.
TEST(SmoothAlbedo, WhatVariancesExplainIsNoEdge) {
    constexpr float D = 0.1f;
    const auto truth = [](uint32_t x) { return x % 2 == 0 ? 0.4f : 0.4f + D; };
    Owned owned(truth);
    for (std::vector<float>& plane : owned.albedo) {
        for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i)
            plane[i] = truth(i % WIDTH);
    }
    std::ranges::fill(owned.variance, 2.0f * D * D);
    const std::vector<vec3> smooth = smooth_albedo(owned.picture(), PICTURE);
    for (uint32_t y = 0; y < HEIGHT; ++y) {
        for (uint32_t x = 2; x < WIDTH - 2; ++x) {
            const float mean = 0.4f + (x % 2 == 0 ? 0.4f : 0.6f) * D;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(smooth[size_t{y} * WIDTH + x][c], mean, 1e-6f) << x << ' ' << y;
        }
    }
}

// Ten deviations apart, patches across the edge differ by more than 30 times what their noise explains, or by
// a third of that where they share two columns of three.
TEST(SmoothAlbedo, EdgesStay) {
    const auto truth = [](uint32_t x) { return x < WIDTH / 2 ? 0.2f : 0.7f; };
    EXPECT_LT(mean_square(smooth_albedo(Owned(truth).picture(), PICTURE), truth), 0.15 * double(VARIANCE));
}

TEST(SmoothAlbedo, WhatDoesNotVaryStaysBitByBit) {
    Owned owned([](uint32_t x) { return x % 2 == 0 ? 0.5f : 0.52f; });
    owned.variance.assign(owned.variance.size(), 0.0f);
    owned.variance[WIDTH + 1] = VARIANCE;
    const std::vector<vec3> smooth = smooth_albedo(owned.picture(), PICTURE);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i)
        ASSERT_EQ(smooth[i] == rgb_at(*owned.picture().albedo, i), i != WIDTH + 1) << i;
}

TEST(SmoothAlbedo, APixelDoesNotDependOnTheRectangle) {
    const Owned owned([](uint32_t x) { return 0.3f + 0.004f * float(x); });
    const std::vector<vec3> whole = smooth_albedo(owned.picture(), PICTURE);
    for (const PixelRect rect :
         {PixelRect{0, 0, 1, 1}, PixelRect{13, 5, 60, 68}, PixelRect{80, 40, 90, 70}}) {
        const std::vector<vec3> part = smooth_albedo(owned.picture(), rect);
        ASSERT_EQ(part.size(), size_t{rect.width()} * rect.height());
        for (uint32_t i = 0; i < part.size(); ++i) {
            const uint32_t x = rect.x0 + i % rect.width(), y = rect.y0 + i / rect.width();
            ASSERT_EQ(part[i], whole[size_t{y} * WIDTH + x]) << x << ' ' << y;
        }
    }
}

// Foreign files may hold anything; a pixel's variance is infinite with one sample.
TEST(SmoothAlbedo, WhatIsNotFiniteStaysAlone) {
    const auto truth = [](uint32_t) { return 0.5f; };
    Owned owned(truth);
    constexpr size_t ODD = 30 * WIDTH + 30, UNKNOWN = 30 * WIDTH + 40, NEGATIVE = 0;
    owned.albedo[1][ODD] = std::numeric_limits<float>::quiet_NaN();
    owned.variance[UNKNOWN] = std::numeric_limits<float>::infinity();
    owned.albedo[0][UNKNOWN] = 1e30f;
    owned.variance[NEGATIVE] = -1.0f;
    owned.albedo[2][NEGATIVE] = 1e30f;
    const std::vector<vec3> smooth = smooth_albedo(owned.picture(), PICTURE);
    for (size_t i = 0; i < smooth.size(); ++i) {
        if (i == ODD) {
            EXPECT_TRUE(std::isnan(smooth[i].y));
        } else if (i == UNKNOWN || i == NEGATIVE) {
            EXPECT_EQ(smooth[i], rgb_at(*owned.picture().albedo, i));
        } else {
            ASSERT_LT(glm::length(smooth[i] - 0.5f), 6.0f * SIGMA) << i;
        }
    }
}

}  // namespace
}  // namespace candela
