// The accumulation state: its means and variances.
#include "film/accumulation.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "unit/film/accumulation_fixture.h"

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

// Two states are pooled, as if one had all samples. Four are two halves of two, and the image is the plain
// mean of both, although here one half has n samples in pixel i, and the other 2n, which are twice as bright.
TEST(Accumulation, HalvesAreAveragedWhateverTheyHold) {
    const auto scaled = [](double factor) {
        Accumulation state = sampled(LAYER_COUNT_AOVS).state;
        for (size_t i = 0; i < state.pixel_count(); ++i) {
            for (int c = 0; c < 3; ++c) {
                set_sum(state, LAYER_L, i, c, factor * double(state.at(LAYER_L, i)[c]));
                set_sum(state, LAYER_SQUARE, i, c, factor * factor * double(state.at(LAYER_SQUARE, i)[c]));
            }
        }
        return state;
    };
    const Accumulation one = scaled(1.0), twice = scaled(2.0);
    const Accumulation none{.full = one.full, .rect = one.rect, .layer_count = one.layer_count, .values = {}};
    const Image single = make_image(one, ALL, some_positions(6));

    const Image pooled = make_image(std::vector{one, twice}, ALL, some_positions(6));
    const Image halves = make_image(std::vector{one, none, twice, twice}, ALL, some_positions(6));
    const Image first_half = make_image(std::vector{one, twice, none, none}, ALL, some_positions(6));
    for (size_t i = 0; i < 6; ++i) {
        for (const char* name : {"R", "G", "B"}) {
            const float mean = single.find(name)->values[i];
            EXPECT_FLOAT_EQ(pooled.find(name)->values[i], 1.5f * mean);
            EXPECT_FLOAT_EQ(halves.find(name)->values[i], 1.5f * mean);
            EXPECT_FLOAT_EQ(first_half.find(name)->values[i], 1.5f * mean);
        }
        for (const char* name : {"A", "Albedo.G", "N.X", "P.Z", "Z"})
            EXPECT_FLOAT_EQ(halves.find(name)->values[i], single.find(name)->values[i]) << name;
        EXPECT_EQ(pooled.find("SampleCount.V")->values[i], float(2 * i));
        EXPECT_EQ(halves.find("SampleCount.V")->values[i], float(3 * i));
        EXPECT_EQ(first_half.find("Variance.G")->values[i], INFINITE);
    }
    // The variance of the mean of independent halves is a quarter of the sum of theirs. The second half is
    // `twice` two times: its samples have four times the variance of one, and there are 2n of them.
    for (size_t i = 2; i < 6; ++i) {
        const double n = double(i), variance = double(single.find("Variance.R")->values[i]);
        const double second = 4.0 * variance * (n - 1.0) / (2.0 * n - 1.0);
        EXPECT_NEAR(halves.find("Variance.R")->values[i], 0.25 * (variance + second), 1e-5 * variance);
    }
}

TEST(Accumulation, StatesAreCountedTogether) {
    const Accumulation one = sampled(LAYER_COUNT_COLOUR).state;
    const Accumulation none{.full = one.full, .rect = one.rect, .values = {}};
    const std::vector states{one, none, one, one};
    const SampleCounts counts = count_samples(states);
    EXPECT_EQ(counts.total, 3u * 15);
    EXPECT_EQ(counts.min, 0u);
    EXPECT_EQ(counts.max, 3u * 5);
    EXPECT_EQ(samples_per_pixel(states), 3u * 15 / 6);
    EXPECT_EQ(samples_per_pixel({&one, 1}), 0u);
    EXPECT_EQ(total_counters(states).rays, 3u * one.counters.rays);
    EXPECT_EQ(total_counters(states).nonfinite_samples, 9u);
    EXPECT_EQ(total_counters(states).depth_limit_hits, 12u);
}

TEST(Accumulation, LimitsAreKeptInTheState) {
    Accumulation state = sampled(LAYER_COUNT_COLOUR).state;
    const Image before = make_image(state, {.variance = true, .sample_count = true}, {});
    EXPECT_EQ(state.limit(2), UINT32_MAX);
    state.set_limit(2, 0);
    state.set_limit(3, (1u << 24) - 1);
    EXPECT_EQ(state.limit(1), UINT32_MAX);
    EXPECT_EQ(state.limit(2), 0u);
    EXPECT_EQ(state.limit(3), (1u << 24) - 1);
    const Image after = make_image(state, {.variance = true, .sample_count = true}, {});
    for (size_t c = 0; c < before.channels.size(); ++c)
        EXPECT_EQ(before.channels[c].values, after.channels[c].values);
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
