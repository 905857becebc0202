// The accumulation state: the means and variances that it stands for.
#include "render/accumulation.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "accumulation_fixture.h"

namespace candela {
namespace {

constexpr AovSelection ALL{true, true, true, true, true, true};

std::vector<float> some_positions(size_t pixels) {
    std::vector<float> positions(pixels * 4);
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i] = float(i);
    return positions;
}

TEST(Accumulation, CountsItsSamples) {
    const Sampled s = sampled(LAYER_COUNT_COLOUR);
    EXPECT_EQ(s.state.pixel_count(), 6u);
    EXPECT_EQ(s.state.total_samples(), 0u + 1 + 2 + 3 + 4 + 5);
}

TEST(Accumulation, MeansAreThoseOfTheSamples) {
    const Sampled s = sampled(LAYER_COUNT_AOVS);
    const Image image = make_image(s.state, ALL, some_positions(6));
    EXPECT_EQ(image.full, uvec2(40, 30));
    EXPECT_EQ(image.data, s.state.rect);
    const RgbPlanes rgb = *image.find_rgb();
    const RgbPlanes albedo = *image.find_rgb("Albedo");
    for (size_t i = 0; i < 6; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0.0;
            for (const vec3 L : s.samples[i])
                sum += L[glm::length_t(c)];
            EXPECT_FLOAT_EQ(rgb[c][i], i == 0 ? 0.0f : float(sum / double(i)));
            EXPECT_EQ(albedo[c][i], i == 0 ? 0.0f : 0.25f);
        }
        EXPECT_EQ(image.find("N.Z")->values[i], i == 0 ? 0.0f : -0.5f);
        EXPECT_FLOAT_EQ(image.find("A")->values[i], i == 0 ? 0.0f : float(i / 2) / float(i));
        EXPECT_EQ(image.find("SampleCount.V")->values[i], float(i));
        EXPECT_EQ(image.find("P.Y")->values[i], float(4 * i + 1));
        EXPECT_EQ(image.find("Z")->values[i], float(4 * i + 3));
    }
}

// Against the textbook's two passes over the samples. The sums hold some 48 bits, of which the difference of
// squares (about 1 part in 300 of them is variance) leaves more than enough for a relative error of 1e-6.
TEST(Accumulation, VarianceIsThatOfTheMean) {
    const Sampled s = sampled(LAYER_COUNT_COLOUR);
    const Image image = make_image(s.state, {.variance = true}, {});
    const RgbPlanes variance = *image.find_rgb("Variance");
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(variance[c][0], INFINITE);
        EXPECT_EQ(variance[c][1], INFINITE);
        for (size_t i = 2; i < 6; ++i) {
            double mean = 0.0, squares = 0.0;
            for (const vec3 L : s.samples[i])
                mean += double(L[glm::length_t(c)]) / double(i);
            for (const vec3 L : s.samples[i])
                squares += std::pow(double(L[glm::length_t(c)]) - mean, 2);
            const double expected = squares / double(i - 1) / double(i);
            EXPECT_NEAR(variance[c][i], expected, 1e-6 * expected);
        }
    }
}

TEST(Accumulation, OnlyTheChannelsAskedForAreThere) {
    const Sampled s = sampled(LAYER_COUNT_COLOUR);
    EXPECT_EQ(make_image(s.state, {}, {}).channels.size(), 4u);
    EXPECT_EQ(make_image(s.state, {.depth = true}, some_positions(6)).channels.size(), 5u);
    EXPECT_EQ(make_image(s.state, {.variance = true, .sample_count = true}, {}).channels.size(), 8u);
}

TEST(Accumulation, TheHashIsThatOfTheColoursInOrder) {
    Image image{.full = uvec2(2, 1), .data = {0, 0, 2, 1}, .channels = {}, .attributes = {}};
    image.add("B").values = {0.0f, 0.0f};
    image.add("A").values = {1.0f, 1.0f};
    image.add("R").values = {1.0f, 0.0f};
    image.add("G").values = {0.0f, -2.0f};
    // FNV-1a of the bytes 00 00 80 3f, 0 x 12, 00 00 00 c0, 0 x 4, computed by its definition.
    uint64_t expected = 14695981039346656037u;
    const float rgb[] = {1.0f, 0.0f, 0.0f, 0.0f, -2.0f, 0.0f};
    unsigned char bytes[sizeof rgb];
    std::memcpy(bytes, rgb, sizeof rgb);
    for (const unsigned char byte : bytes)
        expected = (expected ^ byte) * 1099511628211u;
    EXPECT_EQ(image_hash(image), expected);
    image.channels[2].values[1] = 1e-30f;
    EXPECT_NE(image_hash(image), expected);
}

}  // namespace
}  // namespace candela
