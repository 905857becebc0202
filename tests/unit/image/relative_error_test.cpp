// The relative error of an image: against a reference by hand, and estimated where the truth is known.
#include "image/relative_error.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace candela {
namespace {

// An image whose three channels are `value(i)` at pixel i.
template <class Value>
Image image_of(uint32_t width, uint32_t height, float samples, const Value& value) {
    Image image{.full = {width, height}, .data = {0, 0, width, height}, .channels = {}, .attributes = {}};
    for (const char* name : {"R", "G", "B"}) {
        Channel& channel = image.add(name);
        for (size_t i = 0; i < channel.values.size(); ++i)
            channel.values[i] = float(value(i));
    }
    image.add("SampleCount.V", samples);
    return image;
}

// Two pixels, 1 and 3, and so the mean 2: each square is regularised by 0.04.
TEST(RelativeError, IsTheMeanOfSquaresOverThoseOfTheReference) {
    const Image reference = image_of(2, 1, 1, [](size_t i) { return i == 0 ? 1.0 : 3.0; });
    const Image image = image_of(2, 1, 1, [](size_t i) { return i == 0 ? 1.5 : 2.0; });
    EXPECT_NEAR(relative_mse(*image.find_rgb(), *reference.find_rgb()), 0.5 * (0.25 / 1.04 + 1.0 / 9.04),
                1e-12);
    EXPECT_EQ(relative_mse(*reference.find_rgb(), *reference.find_rgb()), 0.0);
}

class RelativeErrorEstimate : public testing::Test {
  protected:
    static constexpr uint32_t SIZE = 64;

    // The estimate for pixels whose two halves are 1 plus deviates, over the error of their means.
    template <class Deviate>
    double ratio(Deviate deviate) {
        std::vector<double> a(SIZE * SIZE), b(SIZE * SIZE);
        for (size_t i = 0; i < a.size(); ++i) {
            a[i] = 1.0 + deviate(random_);
            b[i] = 1.0 + deviate(random_);
        }
        const Image before = image_of(SIZE, SIZE, 8, [&](size_t i) { return a[i]; });
        const Image now = image_of(SIZE, SIZE, 16, [&](size_t i) { return 0.5 * (a[i] + b[i]); });
        const Image truth = image_of(SIZE, SIZE, 1, [](size_t) { return 1.0; });
        return *estimate_relative_error(before, now) /
               std::sqrt(relative_mse(*now.find_rgb(), *truth.find_rgb()));
    }

    std::mt19937 random_{1};
};

// The mean of the squares of N deviates has a relative standard deviation of sqrt(2 / N), its root half of
// that; here N is 4096, since channels are alike, and both errors have it: sqrt(2) * 0.011 together. Dividing
// by the darker of pixel and neighbours, instead of 1, adds less than the noise of a pixel, 0.01.
TEST_F(RelativeErrorEstimate, IsTheErrorOfIndependentSamples) {
    std::normal_distribution<double> noise(0.0, 0.01);
    EXPECT_NEAR(ratio(noise), 1.0, 4.0 * std::sqrt(2.0) * 0.5 * std::sqrt(2.0 / 4096) + 0.01);
}

// Halves may have any variances: here one has a hundred times that of the other.
TEST_F(RelativeErrorEstimate, ByAHalfIsTheErrorOfTheirMean) {
    std::normal_distribution<double> noise(0.0, 1.0);
    const Image a = image_of(SIZE, SIZE, 8, [&](size_t) { return 1.0 + 0.002 * noise(random_); });
    const Image b = image_of(SIZE, SIZE, 99, [&](size_t) { return 1.0 + 0.02 * noise(random_); });
    const RgbPlanes x = *a.find_rgb(), y = *b.find_rgb();
    const Image mean = image_of(SIZE, SIZE, 107, [&](size_t i) { return 0.5 * (x[0][i] + y[0][i]); });
    // The three channels of each half have noise of their own; those of the mean have that of the first one.
    const auto one_channel = [&](const RgbPlanes& planes) {
        return image_of(SIZE, SIZE, 1, [&](size_t i) { return double(planes[0][i]); });
    };
    const double expected = 0.5 * std::sqrt(0.002 * 0.002 + 0.02 * 0.02) / std::sqrt(1.01);
    for (const Image& half : {one_channel(x), one_channel(y)}) {
        EXPECT_NEAR(*estimate_relative_error_by_half(half, mean) / expected, 1.0,
                    4.0 * 0.5 * std::sqrt(2.0 / 4096) + 0.01);
    }
    EXPECT_FALSE(estimate_relative_error(a, mean)) << "the counts are not doubled";
    const Image black = image_of(SIZE, SIZE, 1, [](size_t) { return 0.0; });
    EXPECT_FALSE(estimate_relative_error_by_half(black, black));
}

// One value in a hundred is 20 too bright, in either half: so some 82 pixels of 4096 are 10 too bright, and
// have moved by as much. For 8 * 2 % of them a neighbour is bright, too; that makes the mean of the
// neighbours 1 + 10 / 8 instead of 1, and takes four fifths of the pixel's square away. So the ratio is the
// root of 1 - 0.16 * 0.8, 0.93, and by chance in which 13 of the 82 pixels it happens, 0.02 more or less.
TEST_F(RelativeErrorEstimate, IsNotBlindedByFireflies) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double found = ratio([&](std::mt19937& random) { return uniform(random) < 0.01 ? 20.0 : 0.0; });
    EXPECT_NEAR(found, 0.93, 4 * 0.02);
}

// Halves whose errors compensate, as those of Sobol points do in part, must not stop a rendering too early.
TEST_F(RelativeErrorEstimate, IsNeverTooSmallWhereHalvesCompensate) {
    std::normal_distribution<double> noise(0.0, 0.01);
    double last = 0.0;
    int count = 0;
    const double found = ratio([&](std::mt19937& random) {
        last = count++ % 2 == 0 ? noise(random) : -0.9 * last;
        return last;
    });
    EXPECT_GT(found, 1.0);
}

TEST_F(RelativeErrorEstimate, IsUnknownWithoutAllSamplesTwiceOrWithoutLight) {
    const auto bright = [](float samples) { return image_of(4, 4, samples, [](size_t) { return 1.0; }); };
    const Image black = image_of(4, 4, 16, [](size_t) { return 0.0; });
    EXPECT_EQ(estimate_relative_error(bright(8), bright(16)), 0.0);
    EXPECT_FALSE(estimate_relative_error(bright(8), bright(15)).has_value());
    EXPECT_FALSE(estimate_relative_error(bright(0), bright(0)).has_value());
    EXPECT_FALSE(estimate_relative_error(black, black).has_value());
    Image uneven = bright(16);
    uneven.channels.back().values[5] = 17;
    EXPECT_FALSE(estimate_relative_error(bright(8), uneven).has_value());
}

// In black surroundings, where the mean is 1/16, the neighbours decide; in bright ones, or without any, the
// pixel itself.
TEST_F(RelativeErrorEstimate, IsRelativeToTheDarkerOfAPixelAndItsNeighbours) {
    const auto spot = [](double value) { return [value](size_t i) { return i == 5 ? value : 0.0; }; };
    const double eps = 0.01 / 256;
    EXPECT_NEAR(*estimate_relative_error(image_of(4, 4, 8, spot(0.5)), image_of(4, 4, 16, spot(1.0))),
                std::sqrt(0.25 / eps / 16), 1e-9);
    const auto dent = [](double value) { return [value](size_t i) { return i == 5 ? value : 1.0; }; };
    const double mean = (15.0 + 0.2) / 16.0;
    EXPECT_NEAR(*estimate_relative_error(image_of(4, 4, 8, dent(0.1)), image_of(4, 4, 16, dent(0.2))),
                std::sqrt(0.01 / (0.04 + 0.01 * mean * mean) / 16), 1e-6);
    const auto one = [](double value) { return [value](size_t) { return value; }; };
    EXPECT_NEAR(*estimate_relative_error(image_of(1, 1, 8, one(0.5)), image_of(1, 1, 16, one(1.0))),
                0.5 / std::sqrt(1.01), 1e-9);
}

}  // namespace
}  // namespace candela
