// The arithmetic of adaptive sampling: where the passes end, and where extra samples go.
#include "session/adaptive.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "film/sample_range.h"

namespace candela {
namespace {

constexpr uint32_t COLUMNS = 96, ROWS = 64, EVEN = 16;

// A state with EVEN samples in every pixel; their mean and variance are mean(x) and variance(x) in all
// channels, and each takes rays(x) rays.
template <class Mean, class Variance, class Rays>
Accumulation even_state(const Mean& mean, const Variance& variance, const Rays& rays) {
    Accumulation state{.full = {COLUMNS, ROWS}, .rect = {0, 0, COLUMNS, ROWS}, .values = {}};
    state.values.resize(state.layer_count * state.pixel_count() * 4);
    for (size_t i = 0; i < state.pixel_count(); ++i) {
        const auto set = [&](uint32_t layer, size_t c, double value) {
            state.values[(layer * state.pixel_count() + i) * 4 + c] = float(value);
        };
        const uint32_t x = uint32_t(i % COLUMNS);
        for (size_t c = 0; c < 3; ++c) {
            set(LAYER_L, c, EVEN * mean(x));
            set(LAYER_SQUARE, c, variance(x) * (EVEN - 1) + EVEN * mean(x) * mean(x));
        }
        set(LAYER_L_COMPENSATION, 3, EVEN);
        set(LAYER_SQUARE_COMPENSATION, 3, EVEN * rays(x));
    }
    return state;
}

double one(uint32_t) {
    return 1.0;
}

Accumulation no_samples() {
    Accumulation state{.full = {COLUMNS, ROWS}, .rect = {0, 0, COLUMNS, ROWS}, .values = {}};
    state.values.resize(state.layer_count * state.pixel_count() * 4);
    return state;
}

double mean_limit(const Accumulation& state) {
    double sum = 0.0;
    for (size_t i = 0; i < state.pixel_count(); ++i)
        sum += state.limit(i);
    return sum / double(state.pixel_count());
}

// A pixel of the middle row.
uint32_t limit_at(const Accumulation& state, uint32_t x) {
    return state.limit(size_t{ROWS / 2} * COLUMNS + x);
}

TEST(Adaptive, PassesEndAtPowersOfTwoAndAtTheTarget) {
    std::vector<uint32_t> ends;
    for (uint32_t spp = 0; spp < 1000; spp = ends.back())
        ends.push_back(next_pass_end(spp, 1000));
    EXPECT_EQ(ends, (std::vector<uint32_t>{32, 64, 128, 256, 512, 1000}));
    EXPECT_EQ(next_pass_end(0, 10), 10u);
    EXPECT_EQ(next_pass_end(33, 1000), 64u);
}

TEST(Adaptive, TheFirstSamplesAndAnEighthOfAllAreEven) {
    EXPECT_EQ(even_samples(1), 1u);
    EXPECT_EQ(even_samples(16), 16u);
    EXPECT_EQ(even_samples(17), 16u);
    EXPECT_EQ(even_samples(128), 16u);
    EXPECT_EQ(even_samples(1024), 128u);
}

// The sum of v / n is least for a given sum of n where n is in proportion to the root of v: with variances of
// 1 and 9, three times as many samples in one half of the picture as in the other, 32 and 96 for a mean of
// 64.
TEST(Adaptive, SamplesAreInProportionToTheRootOfTheVariance) {
    Accumulation extra = no_samples();
    plan_extra_samples(even_state(
                           one, [](uint32_t x) { return x < COLUMNS / 2 ? 1.0 : 9.0; }, one),
                       EVEN, 64, extra);
    for (const uint32_t x : {0u, 5u, COLUMNS / 2 - 1})
        EXPECT_EQ(limit_at(extra, x) + EVEN, 32u);
    for (const uint32_t x : {COLUMNS / 2, COLUMNS - 1})
        EXPECT_EQ(limit_at(extra, x) + EVEN, 96u);
}

// The sum of v / n is least for a given sum of r n, if a sample takes r rays, where n is in proportion to the
// root of v / r.
TEST(Adaptive, AndToThatOfTheirCost) {
    Accumulation extra = no_samples();
    plan_extra_samples(even_state(one, one, [](uint32_t x) { return x < COLUMNS / 2 ? 9.0 : 1.0; }), EVEN, 64,
                       extra);
    EXPECT_EQ(limit_at(extra, 5) + EVEN, 32u);
    EXPECT_EQ(limit_at(extra, COLUMNS - 5) + EVEN, 96u);
}

// Only the error relative to the picture matters: three times as bright and three times as noisy is the same.
// The darkness that is added to the square, 0.01 of the mean's, changes little.
TEST(Adaptive, TheErrorIsRelative) {
    Accumulation extra = no_samples();
    const auto brightness = [](uint32_t x) { return x < COLUMNS / 2 ? 1.0 : 3.0; };
    const auto variance = [&](uint32_t x) { return brightness(x) * brightness(x); };
    plan_extra_samples(even_state(brightness, variance, one), EVEN, 64, extra);
    // 1 / (1 + 0.04) and 9 / (9 + 0.04): their roots differ by 1.7 %, 1.1 samples of 64.
    EXPECT_NEAR(limit_at(extra, 5) + EVEN, 64, 2);
    EXPECT_NEAR(limit_at(extra, COLUMNS - 5) + EVEN, 64, 2);
}

// The work groups of column 50 share its error: eight columns of 96, for which there are 96 * 64 - 88 * 16
// samples. None gets more than 16 times the average.
TEST(Adaptive, EveryPixelKeepsItsEvenSamplesAndNoneGetsMoreThanItsShare) {
    const Accumulation even = even_state(
        one, [](uint32_t x) { return x == 50 ? 1e6 : 0.0; }, one);
    Accumulation extra = no_samples();
    plan_extra_samples(even, EVEN, 64, extra);
    EXPECT_EQ(limit_at(extra, 47), 0u);
    EXPECT_EQ(limit_at(extra, 56), 0u);
    for (const uint32_t x : {48u, 50u, 55u})
        EXPECT_EQ(limit_at(extra, x) + EVEN, (96u * 64 - 88 * 16) / 8);

    Accumulation one_group = even_state(
        one, [](uint32_t) { return 0.0; }, one);
    one_group.values[(LAYER_SQUARE * one_group.pixel_count() + 7) * 4] = 1e6f;
    extra = no_samples();
    plan_extra_samples(one_group, EVEN, 64, extra);
    EXPECT_EQ(extra.limit(0) + EVEN, 16u * 64);
    EXPECT_EQ(extra.limit(7 * COLUMNS + 7) + EVEN, 16u * 64);
    EXPECT_EQ(extra.limit(8), 0u);
    EXPECT_EQ(extra.limit(8 * COLUMNS), 0u);
    plan_extra_samples(one_group, EVEN, 1u << 22, extra);
    EXPECT_EQ(extra.limit(0) + EVEN, MAX_SPP - 1);
}

TEST(Adaptive, ALimitNeverFalls) {
    Accumulation extra = no_samples();
    plan_extra_samples(even_state(
                           one, [](uint32_t x) { return x < COLUMNS / 2 ? 1.0 : 9.0; }, one),
                       EVEN, 64, extra);
    const uint32_t before = limit_at(extra, COLUMNS - 5);
    // The other half of the picture is noisy now, and gets the samples that are added.
    plan_extra_samples(even_state(
                           one, [](uint32_t x) { return x < COLUMNS / 2 ? 9.0 : 1.0; }, one),
                       EVEN, 70, extra);
    EXPECT_EQ(limit_at(extra, COLUMNS - 5), before);
    EXPECT_NEAR(limit_at(extra, 5) + EVEN, 70 + 70 - before - EVEN, 1);
    EXPECT_NEAR(mean_limit(extra) + EVEN, 70, 0.5);
}

// Where nothing tells the pixels apart they get the same: without noise, and without light.
TEST(Adaptive, WithoutNoiseAllPixelsGetTheSame) {
    for (const double brightness : {0.0, 1.0}) {
        Accumulation extra = no_samples();
        const auto mean = [=](uint32_t) { return brightness; };
        const auto variance = [](uint32_t) { return 0.0; };
        plan_extra_samples(even_state(mean, variance, one), EVEN, 64, extra);
        for (size_t i = 0; i < extra.pixel_count(); ++i)
            ASSERT_EQ(extra.limit(i), 64u - EVEN);
    }
}

TEST(Adaptive, TheStatesHaveSeedsOfTheirOwn) {
    RenderSettings settings;
    settings.crop = {0, 0, 8, 8};
    settings.seed = 7;
    const std::vector<Accumulation> states = adaptive_states(settings);
    ASSERT_EQ(states.size(), 4u);
    EXPECT_EQ(states[0].seed, 7u);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(states[i].total_samples(), 0u);
        for (size_t k = 0; k < i; ++k)
            EXPECT_NE(states[i].seed, states[k].seed);
    }
}

}  // namespace
}  // namespace candela
