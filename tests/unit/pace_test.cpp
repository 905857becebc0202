// How coarse a moving picture is, and the estimate of a picture's error.
#include "view/pace.h"

#include <cmath>

#include <gtest/gtest.h>

namespace candela {
namespace {

TEST(Pace, AMovingPictureIsAsFineAsTheDeviceAllows) {
    EXPECT_EQ(next_scale(2, 1.01 * MOVING_SECONDS), 4u);
    EXPECT_EQ(next_scale(2, 0.99 * MOVING_SECONDS), 2u);
    EXPECT_EQ(next_scale(2, 0.21 * MOVING_SECONDS), 2u);
    EXPECT_EQ(next_scale(2, 0.19 * MOVING_SECONDS), 1u);
    // However slow the device, one can see what one does; and there are no more pixels than there are.
    EXPECT_EQ(next_scale(COARSEST_SCALE, 100.0), COARSEST_SCALE);
    EXPECT_EQ(next_scale(1, 0.0), 1u);
    EXPECT_EQ(scaled_size({640, 361}, 4), uvec2(160, 90));
    EXPECT_EQ(scaled_size({3, 1}, 8), uvec2(1, 1));
}

// Devices of any rate that take a fixed time per picture and another per pixel: the scale settles, on a
// picture in time if there is one.
TEST(Pace, TheScaleSettles) {
    for (double pixel_seconds = 1e-9; pixel_seconds < 1e-4; pixel_seconds *= 1.1) {
        const auto seconds = [&](uint32_t scale) {
            return 0.003 + pixel_seconds * 230400.0 / double(scale * scale);
        };
        uint32_t scale = FIRST_SCALE;
        for (int i = 0; i < 4; ++i)
            scale = next_scale(scale, seconds(scale));
        EXPECT_EQ(next_scale(scale, seconds(scale)), scale) << pixel_seconds;
        EXPECT_TRUE(seconds(scale) <= MOVING_SECONDS || scale == COARSEST_SCALE) << pixel_seconds;
    }
}

// A state in which every pixel holds `samples` samples, half of them `low` and half of them `high`.
Accumulation state_of(uint32_t samples, float low, float high) {
    constexpr size_t PIXELS = 6;
    Accumulation state;
    state.full = uvec2(3, 2);
    state.rect = {0, 0, 3, 2};
    state.values.assign(PIXELS * 4 * LAYER_COUNT_COLOUR, 0.0f);
    for (size_t i = 0; i < PIXELS; ++i) {
        const auto at = [&](uint32_t layer) { return &state.values[(layer * PIXELS + i) * 4]; };
        for (int c = 0; c < 3; ++c) {
            at(LAYER_L)[c] = float(samples) / 2 * (low + high);
            at(LAYER_SQUARE)[c] = float(samples) / 2 * (low * low + high * high);
        }
        at(LAYER_L_COMPENSATION)[3] = float(samples);
    }
    return state;
}

// n samples m - d and m + d in equal parts have the variance n/(n - 1) d^2, and their mean has the variance
// d^2 / (n - 1). The image holds it as a float, whose rounding the root halves.
TEST(Pace, TheRelativeErrorIsTheStandardErrorOverTheMean) {
    EXPECT_NEAR(*relative_error(state_of(2, 1.0f, 3.0f)), 1.0 / (2.0 * std::sqrt(1.01)), 1e-7);
    EXPECT_NEAR(*relative_error(state_of(16, 1.0f, 3.0f)), 1.0 / std::sqrt(15.0) / (2.0 * std::sqrt(1.01)),
                1e-7);
    EXPECT_EQ(*relative_error(state_of(16, 2.0f, 2.0f)), 0.0);
}

// Half of the pixels, whose value is 0, have the variance 0; the mean of the others, of value 2, is 1: they
// give 1 / (4 + 0.01) each.
TEST(Pace, TheRelativeErrorIsMeasuredByThePixelAndThePicture) {
    Accumulation state = state_of(2, 1.0f, 3.0f);
    const size_t floats = state.pixel_count() * 4;
    for (size_t i = 0; i < state.values.size(); ++i) {
        if (i % floats < floats / 2 && i % 4 < 3) state.values[i] = 0.0f;
    }
    EXPECT_NEAR(*relative_error(state), std::sqrt(0.5 / 4.01), 1e-7);
    // Pixels with a single sample do not count.
    for (size_t i = 0; i < state.pixel_count() / 2; ++i)
        state.values[LAYER_L_COMPENSATION * floats + 4 * i + 3] = 1.0f;
    EXPECT_NEAR(*relative_error(state), 1.0 / (2.0 * std::sqrt(1.01)), 1e-7);
}

TEST(Pace, TheRelativeErrorIsUnknownFromOneSampleOrOfBlack) {
    EXPECT_FALSE(relative_error(state_of(1, 1.0f, 1.0f)).has_value());
    EXPECT_FALSE(relative_error(state_of(4, 0.0f, 0.0f)).has_value());
}

}  // namespace
}  // namespace candela
