// compare: accepts noise of the stated variance at the stated rate, rejects small but real differences.
#include "image/compare.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "base/statistics.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

constexpr float INF = std::numeric_limits<float>::infinity();
constexpr std::array<const char*, 3> COLOURS = {"R", "G", "B"};
constexpr std::array<const char*, 3> VARIANCES = {"Variance.R", "Variance.G", "Variance.B"};

Image blank(uint32_t width, uint32_t height) {
    Image image;
    image.full = {width, height};
    image.data = {0, 0, width, height};
    return image;
}

Image uniform(uint32_t width, uint32_t height, float value) {
    Image image = blank(width, height);
    for (const char* name : COLOURS)
        image.add(name, value);
    return image;
}

// A smooth picture with Gaussian noise of a relative standard deviation of 5 %, and its variance.
Image noisy(uint32_t width, uint32_t height, unsigned seed) {
    Image image = uniform(width, height, 0.0f);
    for (const char* name : VARIANCES)
        image.add(name);
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const float mean = 0.5f + float(c) + float(i % width) / float(width);
            const float deviation = 0.05f * mean;
            image.channels[c].values[i] = mean + deviation * normal(random);
            image.channels[3 + c].values[i] = deviation * deviation;
        }
    }
    return image;
}

void scale_block(Image& image, PixelRect block, float factor) {
    for (size_t c = 0; c < 3; ++c) {
        for (uint32_t y = block.y0; y < block.y1; ++y) {
            for (uint32_t x = block.x0; x < block.x1; ++x) {
                image.channels[c].values[y * image.data.width() + x] *= factor;
            }
        }
    }
}

TEST(Compare, RelmseIsTheMeanOfRelativeSquaredErrors) {
    Image a = uniform(2, 1, 0.0f);
    Image b = uniform(2, 1, 0.0f);
    a.channels[0].values = {3.0f, 0.0f};
    b.channels[0].values = {1.0f, 0.0f};
    a.channels[2].values = {0.0f, 0.1f};
    const Comparison result = compare(a, b);
    EXPECT_NEAR(result.relmse, (4.0 / 1.01 + 0.01 / 0.01) / 6.0, 1e-7);
    EXPECT_FALSE(result.tests);
    EXPECT_NE(compare(b, a).relmse, result.relmse) << "the second image is the reference";
}

TEST(Compare, WithoutVarianceRelmseDecides) {
    const Image b = uniform(9, 9, 1.0f);
    EXPECT_TRUE(compare(b, b).passed);
    EXPECT_EQ(compare(b, b).relmse, 0.0);
    // (a - 1)^2 / 1.01 = 1e-3 at a = 1.03178.
    EXPECT_TRUE(compare(uniform(9, 9, 1.0317f), b).passed);
    EXPECT_FALSE(compare(uniform(9, 9, 1.0319f), b).passed);
    EXPECT_TRUE(compare(uniform(9, 9, 1.5f), b, {.relmse = 0.3}).passed);
    EXPECT_FALSE(compare(uniform(9, 9, 1.0317f), b, {.relmse = 1e-4}).passed);
    Image with_variance = uniform(9, 9, 1.0f);
    for (const char* name : VARIANCES)
        with_variance.add(name, 1.0f);
    EXPECT_FALSE(compare(with_variance, b).tests);
    EXPECT_FALSE(compare(b, with_variance).tests);
}

TEST(Compare, AcceptsTwoNoisyImagesOfOneMean) {
    const Comparison result = compare(noisy(100, 70, 1), noisy(100, 70, 2));
    EXPECT_TRUE(result.passed);
    ASSERT_TRUE(result.tests);
    EXPECT_GT(result.tests->passing_pixels, 0.9999);
    EXPECT_GT(result.relmse, 1e-3) << "relMSE alone would have rejected them";
    EXPECT_GT(std::abs(result.tests->pixel.z), 3.0) << "21000 deviates without one beyond 3 would be odd";
}

TEST(Compare, CorrectsForTheNumberOfTests) {
    const ZTests tests = *compare(noisy(100, 70, 1), noisy(100, 70, 2), {.alpha = 0.05}).tests;
    EXPECT_DOUBLE_EQ(tests.pixel.critical, normal_critical_z(sidak_level(0.05, 100 * 70 * 3)));
    EXPECT_DOUBLE_EQ(tests.block.critical, normal_critical_z(sidak_level(0.05, 13 * 9 * 3)));
    EXPECT_DOUBLE_EQ(tests.mean.critical, normal_critical_z(sidak_level(0.05, 3)));
}

TEST(Compare, RejectsAnImageThatIsOnePercentBrighter) {
    Image brighter = noisy(64, 64, 1);
    scale_block(brighter, brighter.data, 1.01f);
    const Comparison result = compare(brighter, noisy(64, 64, 2));
    EXPECT_FALSE(result.passed);
    EXPECT_GT(result.tests->passing_pixels, 0.9999) << "single pixels cannot tell";
    EXPECT_GT(result.tests->mean.z, result.tests->mean.critical);
    EXPECT_EQ(result.tests->mean.place, brighter.data);
}

// A quarter of one channel is 2 % off, with 5 % of noise in each pixel: the mean of its 16 blocks, 1024
// pixels, is 2 % / (5 % sqrt(2 / 1024)) = 9 deviations off, that of the image half as many, 4.5; 3.1 suffice
// to reject. Whether the 16 blocks, 2.3 deviations each, are noticed is chance.
TEST(Compare, RejectsAQuarterOfAChannelThatIsTwoPercentOff) {
    int rejected = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        Image off = noisy(64, 64, 2 * seed);
        for (size_t i = 0; i < off.pixel_count() / 4; ++i)
            off.channels[1].values[i] *= 1.02f;
        rejected += compare(off, noisy(64, 64, 2 * seed + 1), {.alpha = 0.01}).passed ? 0 : 1;
    }
    EXPECT_GE(rejected, 44);  // 50 images, each with 92 % by the mean alone: 46 +- 2.
}

TEST(Compare, RejectsAMeanThatNoBlockCanTell) {
    Image brighter = noisy(128, 128, 1);
    scale_block(brighter, brighter.data, 1.004f);
    const Comparison result = compare(brighter, noisy(128, 128, 2));
    EXPECT_FALSE(result.passed);
    EXPECT_TRUE(result.tests->block.passed());
    EXPECT_FALSE(result.tests->mean.passed());
}

TEST(Compare, RejectsASingleWrongBlockAndSaysWhere) {
    Image wrong = noisy(100, 70, 1);
    const PixelRect block{40, 64, 48, 70};  // At the lower edge, where blocks are cut.
    scale_block(wrong, block, 0.9f);
    const Comparison result = compare(wrong, noisy(100, 70, 2));
    EXPECT_FALSE(result.passed);
    EXPECT_GT(result.tests->passing_pixels, 0.9999);
    EXPECT_TRUE(result.tests->mean.passed());
    EXPECT_FALSE(result.tests->block.passed());
    EXPECT_EQ(result.tests->block.place, block);
    EXPECT_LT(result.tests->block.z, 0.0) << "it is darker";
}

TEST(Compare, PlacesAreInTheWholePicture) {
    Image a = noisy(20, 20, 1);
    Image b = noisy(20, 20, 2);
    for (Image* image : {&a, &b}) {
        image->full = {400, 300};
        image->data = {100, 200, 120, 220};
    }
    a.channels[1].values[20 * 9 + 17] = 100.0f;
    const ZTests tests = *compare(a, b).tests;
    EXPECT_EQ(tests.pixel.place, (PixelRect{117, 209, 118, 210}));
    EXPECT_EQ(tests.block.place, (PixelRect{116, 208, 120, 216}));
    EXPECT_EQ(tests.pixel.channel, 'G');
    EXPECT_EQ(tests.block.channel, 'G');
}

TEST(Compare, ToleratesFewWildPixelsOnly) {
    // Outliers come in pairs of equal size, so that the means stay; their variance is understated.
    for (const size_t pairs : {12u, 13u}) {  // 24 of 10 000 pixels are 0.24 %, 26 are 0.26 %.
        Image a = uniform(100, 100, 1.0f);
        Image b = uniform(100, 100, 1.0f);
        for (const char* name : VARIANCES) {
            a.add(name, 0.5e-4f);
            b.add(name, 0.5e-4f);
        }
        for (size_t i = 0; i < pairs; ++i) {
            a.channels[1].values[i * 8] += 0.1f;  // 10 standard deviations.
            a.channels[1].values[i * 8 + 1] -= 0.1f;
        }
        const Comparison result = compare(a, b);
        EXPECT_NEAR(result.tests->passing_pixels, 1.0 - double(2 * pairs) / 1e4, 1e-12);
        EXPECT_EQ(result.passed, pairs == 12);
        EXPECT_NEAR(result.tests->pixel.z, 10.0, 1e-3);
    }
}

// With the null hypothesis true, each family of tests rejects with probability alpha: a wrong variance of a
// mean, a one-sided p-value or a missing correction would show as another rate.
TEST(Compare, RejectsEqualExpectationsAtTheStatedRate) {
    constexpr int RUNS = 600;
    constexpr double ALPHA = 0.2;
    int pixel = 0;
    int block = 0;
    int mean = 0;
    for (unsigned i = 0; i < RUNS; ++i) {
        const ZTests tests = *compare(noisy(20, 17, 2 * i), noisy(20, 17, 2 * i + 1), {.alpha = ALPHA}).tests;
        pixel += tests.pixel.passed() ? 0 : 1;
        block += tests.block.passed() ? 0 : 1;
        mean += tests.mean.passed() ? 0 : 1;
    }
    const double deviation = std::sqrt(RUNS * ALPHA * (1.0 - ALPHA));
    for (const int rejected : {pixel, block, mean}) {
        EXPECT_GT(normal_p_value((rejected - RUNS * ALPHA) / deviation), 1e-3) << rejected;
    }
}

TEST(Compare, WithoutAnyVarianceOnlyEqualValuesPass) {
    Image a = uniform(16, 8, 1.0f);
    for (const char* name : VARIANCES)
        a.add(name, 0.0f);
    Image b = a;
    EXPECT_TRUE(compare(a, b).passed);
    EXPECT_EQ(compare(a, b).tests->pixel.z, 0.0);
    b.channels[2].values[9] = 1.5f;
    const Comparison result = compare(a, b);
    EXPECT_FALSE(result.passed);
    EXPECT_EQ(result.tests->pixel.z, -double(INF));
    EXPECT_EQ(result.tests->pixel.place, (PixelRect{9, 0, 10, 1}));
    EXPECT_EQ(result.tests->block.place, (PixelRect{8, 0, 16, 8}));
    EXPECT_EQ(result.tests->passing_pixels, 127.0 / 128.0);
}

TEST(Compare, AnExplicitRelmseOverrulesTheTests) {
    Image brighter = noisy(64, 64, 1);
    scale_block(brighter, brighter.data, 1.01f);
    const Image b = noisy(64, 64, 2);
    const Comparison result = compare(brighter, b, {.relmse = 0.1});
    EXPECT_TRUE(result.passed);
    ASSERT_TRUE(result.tests) << "the figures are there either way";
    EXPECT_FALSE(result.tests->passed());
    EXPECT_FALSE(compare(noisy(64, 64, 1), b, {.relmse = 1e-9}).passed);
}

TEST(Compare, SaysWhyImagesCannotBeCompared) {
    const Image b = uniform(8, 8, 1.0f);
    const auto message = [&](const Image& a) { return error_of([&] { compare(a, b); }); };
    EXPECT_EQ(message(uniform(9, 8, 1.0f)),
              "cannot compare: image A has 9x8 pixels, image B 8x8; render both at one size");
    Image crop = b;
    crop.data = {0, 0, 4, 8};
    EXPECT_EQ(message(crop),
              "cannot compare: image A is the crop 0,0,4,8, image B the crop 0,0,8,8 (x0,y0,x1,y1); render "
              "both with "
              "one crop");
    Image grey = blank(8, 8);
    EXPECT_EQ(message(grey), "cannot compare: image A lacks a channel R, G or B (it has: none)");
    grey.add("B");
    grey.add("Y");
    EXPECT_EQ(message(grey), "cannot compare: image A lacks a channel R, G or B (it has: B, Y)");
    EXPECT_EQ(error_of([] { compare(Image{}, Image{}); }), "cannot compare: the images have no pixels");
}

TEST(Compare, RefusesValuesThatAreNotFinite) {
    Image a = noisy(8, 8, 1);
    const Image b = noisy(8, 8, 2);
    const std::string remedy = "; render it again without non-finite samples";
    a.channels[1].values[8 * 3 + 2] = INF;
    EXPECT_EQ(error_of([&] { compare(a, b); }),
              "cannot compare: image A, channel \"G\" is inf at pixel (2, 3)" + remedy);
    a.channels[1].values[8 * 3 + 2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(error_of([&] { compare(b, a); }),
              "cannot compare: image B, channel \"G\" is nan at pixel (2, 3)" + remedy);
    a.channels[1].values[8 * 3 + 2] = 1.0f;
    a.channels[5].values[0] = -1.0f;
    EXPECT_EQ(error_of([&] { compare(a, b); }),
              "cannot compare: image A, channel \"Variance.B\" is -1.000000 at pixel (0, 0)" + remedy);
}

std::array<uint8_t, 3> pixel_of(const std::vector<uint8_t>& bytes, size_t i) {
    return {bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]};
}

double luminance(std::array<uint8_t, 3> c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

TEST(Compare, HeatmapGrowsBrighterWithTheError) {
    Image a = uniform(64, 1, 1.0f);
    const Image b = a;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < 64; ++i)
            a.channels[c].values[i] += float(std::pow(10.0, double(i) / 20.0 - 3.2));
    }
    a.channels[0].values[0] = a.channels[1].values[0] = a.channels[2].values[0] = 1.0f;
    const std::vector<uint8_t> bytes = heatmap(a, b);
    ASSERT_EQ(bytes.size(), 192u);
    for (size_t i = 1; i < 64; ++i) {
        EXPECT_GE(luminance(pixel_of(bytes, i)), luminance(pixel_of(bytes, i - 1)) - 0.5) << i;
    }
    EXPECT_LT(luminance(pixel_of(bytes, 0)), 2.0);
    EXPECT_EQ(luminance(pixel_of(bytes, 1)), luminance(pixel_of(bytes, 2))) << "below 1e-6 all is black";
    EXPECT_GT(luminance(pixel_of(bytes, 63)), 235.0);
    // Half way, at a relative squared error of 1e-3, inferno has the colour (188, 55, 84).
    EXPECT_NEAR(pixel_of(bytes, 34)[0], 188, 8);
    EXPECT_NEAR(pixel_of(bytes, 34)[1], 55, 8);
    EXPECT_NEAR(pixel_of(bytes, 34)[2], 84, 8);
}

TEST(Compare, HeatmapShowsDeviationsWhereTheTestsDecide) {
    Image a = uniform(8, 8, 1.0f);
    for (const char* name : VARIANCES)
        a.add(name, 0.5e-4f);
    const Image b = a;
    const double critical = compare(a, b).tests->pixel.critical;
    a.channels[0].values[1] += float(0.01 * critical);
    a.channels[2].values[2] -= float(0.005 * critical);
    a.channels[2].values[3] -= 5.0f;
    const std::vector<uint8_t> bytes = heatmap(a, b);
    EXPECT_LT(luminance(pixel_of(bytes, 0)), 2.0);
    EXPECT_GT(luminance(pixel_of(bytes, 1)), 235.0);
    EXPECT_NEAR(luminance(pixel_of(bytes, 2)), luminance({188, 55, 84}), 4.0);
    EXPECT_EQ(pixel_of(bytes, 3), pixel_of(bytes, 1));
    EXPECT_LT(luminance(pixel_of(heatmap(a, b, {.relmse = 1e-3}), 2)), luminance(pixel_of(bytes, 2)) * 1.5);
    Image other = uniform(9, 8, 1.0f);
    EXPECT_EQ(error_of([&] { heatmap(other, b); }),
              "cannot compare: image A has 9x8 pixels, image B 8x8; render both at one size");
}

}  // namespace
}  // namespace candela
