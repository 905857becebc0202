// The blend of a denoised picture with the noisy one: its weights, and that it is never much worse than the
// noisy one.
#include "denoise/blend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "probe/random.h"

namespace candela {
namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr uvec2 SIZE(120, 99);
constexpr size_t PIXEL_COUNT = size_t{SIZE.x} * SIZE.y;

using Planes = std::array<std::vector<float>, 3>;

Planes filled(float value) {
    Planes planes;
    for (std::vector<float>& plane : planes)
        plane.assign(PIXEL_COUNT, value);
    return planes;
}

// The value, and that much more or less on a checkerboard, so that neighbours do not agree.
Planes checkered(float value, float difference) {
    Planes planes = filled(value);
    for (std::vector<float>& plane : planes) {
        for (uint32_t i = 0; i < PIXEL_COUNT; ++i)
            plane[i] += (i % SIZE.x + i / SIZE.x) % 2 == 0 ? difference : -difference;
    }
    return planes;
}

RgbPlanes view(const Planes& planes) {
    return {planes[0], planes[1], planes[2]};
}

std::vector<float> weights_of(const Planes& noisy, const Planes& variance, const Planes& denoised,
                              float own = 0.0f) {
    return noisy_weights(SIZE, view(noisy), view(variance),
                         {denoised, {}, std::vector<float>(PIXEL_COUNT, own)});
}

// All pixels differ by 0.1. Where the variance is V, noise explains 1.1 (1 - s) V of the squared difference.
TEST(Blend, TheWeightIsTheShareOfTheDifferenceThatNoiseDoesNotExplain) {
    const Planes noisy = checkered(1.0f, 0.1f);
    for (const float variance : {0.008f, 1e-3f, 1e-6f}) {
        for (const float own : {0.0f, 0.25f}) {
            const double expected = 1.0 - 1.1 * (1.0 - own) * variance / 0.01;
            for (const float weight : weights_of(noisy, filled(variance), filled(1.0f), own))
                EXPECT_NEAR(weight, expected, 1e-5);
        }
    }
    for (const float weight : weights_of(noisy, filled(0.02f), filled(1.0f)))
        EXPECT_EQ(weight, 0.0f);
}

// The same where the variance counts for 120 %.
TEST(Blend, WithFewSamplesMoreIsTakenForNoise) {
    const Planes noisy = checkered(1.0f, 0.1f), variance = filled(0.008f);
    for (const double samples : {1.0, 16.0}) {
        for (const float weight :
             noisy_weights(SIZE, view(noisy), view(variance), {filled(1.0f), {}, {}}, samples))
            EXPECT_NEAR(weight, 1.0 - 1.2 * 0.8, 1e-5);
    }
    // A quarter of the way from 16 to 256 samples.
    for (const float weight : noisy_weights(SIZE, view(noisy), view(variance), {filled(1.0f), {}, {}}, 32.0))
        EXPECT_NEAR(weight, 1.0 - 1.15 * 0.8, 1e-5);
}

// The same where the variance counts for a tenth.
TEST(Blend, WithManySamplesLessIsTakenForNoise) {
    const Planes noisy = checkered(1.0f, 0.1f), variance = filled(0.008f);
    const std::vector<float> weights =
        noisy_weights(SIZE, view(noisy), view(variance), {filled(1.0f), {}, {}}, 4096.0);
    for (const float weight : weights)
        EXPECT_NEAR(weight, 1.0 - 0.1 * 0.8, 1e-5);
}

// Half of the pixels, on a checkerboard, found light, 1 + d, and tell a variance of 1. The others have 1 - d,
// and a variance of v after it was raised. In the window of one of these, 41 of 81 weights are those of its
// own kind.
double expected_in_the_dark(double d, double v, double noise_share) {
    const double square = 41.0 * d * d / (1.0 + v) + 40.0 * d * d / 2.0;
    return 1.0 - noise_share * (41.0 * v / (1.0 + v) + 40.0 / 2.0) / square;
}

float weight_in_the_dark(float d, float variance, double samples) {
    const Planes noisy = checkered(1.0f, d);
    Planes variances = filled(variance);
    for (std::vector<float>& plane : variances) {
        for (size_t i = 0; i < PIXEL_COUNT; ++i)
            if (noisy[0][i] > 1.0f) plane[i] = 1.0f;
    }
    return noisy_weights(SIZE, view(noisy), view(variances), {filled(1.0f), {}, {}},
                         samples)[10 * SIZE.x + 11];
}

// Few samples that found nothing tell a variance of 0, and have the mean of the window; many are believed.
TEST(Blend, WithFewSamplesWhatFoundNothingHasTheVarianceOfThoseAround) {
    EXPECT_NEAR(weight_in_the_dark(1.0f, 0.0f, 16.0), expected_in_the_dark(1.0, 40.0 / 81.0, 1.2), 1e-5);
    EXPECT_NEAR(weight_in_the_dark(1.0f, 0.0f, 4096.0), expected_in_the_dark(1.0, 0.0, 0.1), 1e-5);
}

// The picture is 1 on the left, where noise explains 1.2 % of the differences, and 10 on the right, where it
// explains all. What lies across an edge tells nothing about a pixel's variance.
TEST(Blend, TheVarianceIsRaisedToThatOfSimilarPixelsAlone) {
    Planes noisy = checkered(1.0f, 0.1f), variance = filled(1e-4f), denoised = filled(1.0f);
    for (size_t i = 0; i < PIXEL_COUNT; ++i) {
        if (i % SIZE.x < SIZE.x / 2) continue;
        for (size_t c = 0; c < 3; ++c) {
            noisy[c][i] += 9.0f;
            variance[c][i] = 25.0f;
            denoised[c][i] = 10.0f;
        }
    }
    const std::vector<float> weights =
        noisy_weights(SIZE, view(noisy), view(variance), {denoised, {}, {}}, 16.0);
    // The window three columns left of the first of the right half has none of that half.
    const size_t at = 10 * SIZE.x + SIZE.x / 2;
    EXPECT_NEAR(weights[at - 3], 1.0 - 1.2 * 0.01, 1e-5);
    EXPECT_EQ(weights[at + 2], 0.0f);
}

// One pixel has a variance of 10^6, and the denoised values are similar: for the pixels around it, that
// counts as 2. So each of these gets 2 w / 81, with w the outlier's weight in its window.
TEST(Blend, AnOutliersVarianceSaysLittleAboutThePixelsAround) {
    const Planes noisy = checkered(1.0f, 1.0f);
    Planes variance = filled(0.0f);
    const size_t at = 10 * SIZE.x + 10;
    for (size_t c = 0; c < 3; ++c)
        variance[c][at] = 1e6f;
    const std::vector<float> weights =
        noisy_weights(SIZE, view(noisy), view(variance), {filled(1.0f), {}, {}}, 16.0);
    // Four columns from the outlier, the window's outermost column alone has noise. A pixel in its row v has
    // the weight w(v) in this window, and so has the outlier in that pixel's.
    double noise = 0.0, square = 0.0;
    for (int v = -2; v <= 2; ++v) {
        const double weight = 3.0 - std::abs(v), raised = 2.0 * weight / 81.0;
        noise += weight * raised / (1.0 + raised);
        square += weight * (8.0 + 1.0 / (1.0 + raised));
    }
    EXPECT_NEAR(weights[at + 4], 1.0 - 1.2 * noise / square, 1e-5);
}

// Differences of one sign are a bias, however great the variance is said to be. Near the picture's edge,
// there are fewer that agree.
TEST(Blend, WhereNeighboursAgreeTheDifferenceIsABias) {
    const std::vector<float> weights = weights_of(filled(1.1f), filled(1.0f), filled(1.0f));
    for (size_t i = 0; i < PIXEL_COUNT; ++i) {
        const uvec2 pixel(i % SIZE.x, i / SIZE.x), margin = min(pixel, SIZE - 1u - pixel);
        if (std::min(margin.x, margin.y) >= 2) {
            EXPECT_EQ(weights[i], 1.0f) << i;
        } else {
            EXPECT_GE(weights[i], 0.5f) << i;
        }
    }
}

// Two outliers side by side agree, but one product of differences is no agreement, even where each window
// along a row has one.
TEST(Blend, WhatAgreesByChanceIsNoBias) {
    Planes noisy = filled(1.0f);
    for (size_t c = 0; c < 3; ++c) {
        for (uint32_t x = 0; x + 1 < SIZE.x; x += 5)
            noisy[c][10 * SIZE.x + x] = noisy[c][10 * SIZE.x + x + 1] = 1.5f;
    }
    for (const float weight : weights_of(noisy, filled(0.25f), filled(1.0f)))
        EXPECT_EQ(weight, 0.0f);
}

// Three by three pixels that agree are no edge, but chance in a window of heavy-tailed noise; two rows are an
// edge.
TEST(Blend, WhatAgreesInASpotIsNoBias) {
    const auto weight_of = [](uvec2 agreeing) {
        Planes noisy = filled(1.0f);
        for (size_t c = 0; c < 3; ++c) {
            for (uint32_t y = 0; y < agreeing.y; ++y)
                std::fill_n(&noisy[c][(40 + y) * SIZE.x + 40], agreeing.x, 1.5f);
        }
        return weights_of(noisy, filled(0.25f), filled(1.0f))[41 * SIZE.x + 41];
    };
    EXPECT_EQ(weight_of({3, 3}), 0.0f);
    EXPECT_EQ(weight_of({60, 2}), 1.0f);
}

// Noise explains all differences but that of one pixel, whose square is four times theirs. It has 9 of the 81
// weights of its own window, and at most 6 in those around; the variance would explain 7.5.
TEST(Blend, WhatNoiseDoesNotExplainInOneWindowAloneIsChance) {
    Planes noisy = checkered(1.0f, 0.1f);
    const size_t at = 10 * SIZE.x + 10;
    for (size_t c = 0; c < 3; ++c)
        noisy[c][at] = 1.2f;
    const float variance = float((81.0 + 7.5 * 3.0) / 81.0 * 0.01 / 1.1);
    EXPECT_EQ(weights_of(noisy, filled(variance), filled(1.0f))[at], 0.0f);
}

// A pixel in which one sample met the sun by chance: its own noise counts, though around it all is bias. The
// window shows a squared difference of at most 1 a channel, relative to the level; noise is 10^6 times that
// of the denoised value, less four times that of the window (at most 1). So the weight is at most 1 / 1.1 of
// 1 / (10^6 - 4).
TEST(Blend, AnOutlierIsReplacedWhereItsNeighboursStay) {
    Planes noisy = filled(1.1f), variance = filled(0.001f);
    const size_t at = 10 * SIZE.x + 10;
    for (size_t c = 0; c < 3; ++c) {
        noisy[c][at] = 1000.0f;
        variance[c][at] = 1e6f;
    }
    const std::vector<float> weights = weights_of(noisy, variance, filled(1.0f));
    EXPECT_LE(weights[at], 1.0f / 1'099'000.0f);
    EXPECT_EQ(weights[at + 5], 1.0f);
}

// A lamp of one pixel, which the denoiser spread: its noise is great beside the denoised value, but explains
// no more than 1.5 % of the difference, and that which it raises around it, no more than 3 % of the window's.
TEST(Blend, WhatItsOwnNoiseDoesNotExplainIsNoOutlier) {
    Planes noisy = checkered(1.0f, 0.01f), variance = filled(1e-4f);
    const size_t at = 10 * SIZE.x + 10;
    for (size_t c = 0; c < 3; ++c) {
        noisy[c][at] = 101.0f;
        variance[c][at] = 100.0f;
    }
    EXPECT_GE(weights_of(noisy, variance, filled(1.0f))[at], 0.97f);
}

TEST(Blend, WithoutNoiseItIsTheNoisyPictureBitByBit) {
    const Planes noisy = filled(0.1f);
    Denoised denoised{filled(0.7f), std::vector<float>(PIXEL_COUNT, 0.3f), {}};
    const std::vector<float> alpha(PIXEL_COUNT, 0.9f);
    blend(noisy_weights(SIZE, view(noisy), view(filled(0.0f)), denoised), view(noisy), alpha, denoised);
    EXPECT_EQ(denoised.rgb, noisy);
    EXPECT_EQ(denoised.alpha, alpha);
}

// The weights are those of a window of 5 x 5: a pixel three away changes nothing.
TEST(Blend, ValuesThatAreNotFiniteStayWhereTheyAre) {
    Planes noisy = checkered(1.0f, 0.1f), variance = filled(0.001f), denoised = filled(1.0f);
    const std::vector<float> clean = weights_of(noisy, variance, denoised);
    const size_t at = 10 * SIZE.x + 10;
    noisy[1][at] = NOT_A_NUMBER;
    variance[0][at + 5] = INFINITE;
    denoised[2][at + 10] = NOT_A_NUMBER;
    const std::vector<float> weights = weights_of(noisy, variance, denoised);
    EXPECT_EQ(weights[at], 0.0f);
    EXPECT_EQ(weights[at + 5], 0.0f);
    EXPECT_EQ(weights[at + 10], 1.0f);
    for (size_t i = 0; i < PIXEL_COUNT; ++i) {
        if (i == at || i == at + 5 || i == at + 10) continue;
        EXPECT_NEAR(weights[i], clean[i], 1e-5) << i;
    }
}

// A value that cannot be light counts as missing, and overflows nothing.
TEST(Blend, TheGreatestValuesAreReplaced) {
    Planes noisy = checkered(1.0f, 0.1f);
    noisy[0][500] = 3e38f;
    const std::vector<float> weights = weights_of(noisy, filled(0.001f), filled(1.0f));
    EXPECT_EQ(weights[500], 0.0f);
    EXPECT_NEAR(weights[501], 1.0 - 1.1 * 0.1, 1e-5);
}

// Weights are computed in strips of rows. A picture without its first rows has other strips. A weight follows
// from pixels up to 11 away: 6 by the lines, 2 by the window, 1 by neighbours, and 2 by their variances.
TEST(Blend, StripsLeaveNoTrace) {
    constexpr uint32_t ROWS = 16, REACH = 11;
    Random random(12);
    Planes noisy = filled(0.0f);
    for (std::vector<float>& plane : noisy) {
        for (float& value : plane)
            value = 0.5f + random.unit();
    }
    const auto without_rows = [&](const Planes& planes) {
        Planes rest;
        for (size_t c = 0; c < 3; ++c)
            rest[c].assign(planes[c].begin() + ROWS * SIZE.x, planes[c].end());
        return rest;
    };
    const Planes variance = filled(0.05f), denoised = filled(1.0f);
    const std::vector<float> weights = weights_of(noisy, variance, denoised);
    const std::vector<float> others =
        noisy_weights({SIZE.x, SIZE.y - ROWS}, view(without_rows(noisy)), view(without_rows(variance)),
                      {without_rows(denoised), {}, {}});
    for (size_t i = (ROWS + REACH) * SIZE.x; i < PIXEL_COUNT; ++i)
        ASSERT_NEAR(weights[i], others[i - ROWS * SIZE.x], 1e-6) << i;
}

TEST(Blend, OnePixelIsEnough) {
    const std::vector<float> noisy{1.1f}, variance{0.001f};
    const Denoised denoised{{std::vector{1.0f}, std::vector{1.0f}, std::vector{1.0f}}, {}, {}};
    const std::vector<float> weights = noisy_weights({1, 1}, RgbPlanes{noisy, noisy, noisy},
                                                     RgbPlanes{variance, variance, variance}, denoised);
    ASSERT_EQ(weights.size(), 1u);
    EXPECT_NEAR(weights[0], 1.0 - 1.1 * 0.1, 1e-5);
}

// Gaussian noise of deviation 1, and a denoised picture with a bias of b or -b in each pixel. With D the mean
// of d^2 in a window, the blend is the noisy value minus 1.1 d / D. By Stein's lemma its risk is at most
//     1 + E (1.1^2 - 2 * 1.1 + 4 * 1.1 omega) / D,
// where omega is the weight of a value in its own window, at most 9 of 81 over three channels, and more only
// at the picture's edge. E 1/D is at least 1 / E D = 1 / (1 + b^2). Weights below 0 would be worse than 0.
// The mean over the picture differs by chance, by the product of noise and bias, with 2 w (1 - w) b for each
// value.
TEST(Blend, ItIsNeverWorseThanTheNoisyPicture) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    for (const double bias : {0.0, 0.3, 1.0, 2.0, 5.0, 30.0}) {
        const float deviation = 0.05f;
        Planes noisy = filled(0.0f);
        for (std::vector<float>& plane : noisy) {
            for (float& value : plane)
                value = 1.0f + deviation * normal(random);
        }
        Denoised denoised{checkered(1.0f, deviation * float(bias)), {}, {}};
        const auto error = [](const Planes& planes) {
            double sum = 0.0;
            for (const std::vector<float>& plane : planes) {
                for (const float value : plane)
                    sum += std::pow(double(value) - 1.0, 2.0);
            }
            return sum;
        };
        const double before = error(noisy);
        blend(noisy_weights(SIZE, view(noisy), view(filled(deviation * deviation)), denoised), view(noisy),
              {}, denoised);
        const double omega = 9.0 / 81.0 / 3.0,
                     gain = (2 * 1.1 - 1.1 * 1.1 - 4 * 1.1 * omega) / (1 + bias * bias);
        const double w = std::max(0.0, 1.0 - 1.1 / (1.0 + bias * bias));
        const double chance = 4.0 * 2.0 * w * (1.0 - w) * bias / std::sqrt(3.0 * PIXEL_COUNT);
        EXPECT_LT(error(denoised.rgb) / before, 1.0 - gain + chance) << bias;
    }
}

}  // namespace
}  // namespace candela
