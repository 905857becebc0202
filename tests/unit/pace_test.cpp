// How coarse a moving picture is, and when one at rest is looked at.
#include "view/pace.h"

#include <gtest/gtest.h>

#include "base/relative_error.h"
#include "film/sample_range.h"

namespace candela {
namespace {

TEST(Pace, AMovingPictureIsAsFineAsTheDeviceAllows) {
    EXPECT_EQ(next_scale(2, 1.01 * MOVING_SECONDS), 4u);
    EXPECT_EQ(next_scale(2, 0.99 * MOVING_SECONDS), 2u);
    EXPECT_EQ(next_scale(2, 0.21 * MOVING_SECONDS), 2u);
    EXPECT_EQ(next_scale(2, 0.19 * MOVING_SECONDS), 1u);
    // However slow the device, the picture does not become coarser than this; nor ever finer than it is.
    EXPECT_EQ(next_scale(COARSEST_SCALE, 100.0), COARSEST_SCALE);
    EXPECT_EQ(next_scale(1, 0.0), 1u);
    EXPECT_EQ(scaled_size({640, 361}, 4), uvec2(160, 90));
    EXPECT_EQ(scaled_size({3, 1}, 8), uvec2(1, 1));
}

// On devices of any speed, which take a fixed time per picture and another per pixel, the scale settles: on a
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

// The stages that the estimate of `render --target-error` compares, from half of its first on.
TEST(Pace, APictureIsLookedAtAtPowersOfTwo) {
    EXPECT_EQ(next_look(0, 1000), LEAST_ESTIMATED_SPP / 2);
    EXPECT_EQ(next_look(LEAST_ESTIMATED_SPP / 2, 1000), LEAST_ESTIMATED_SPP);
    EXPECT_EQ(next_look(16, 1000), 32u);
    EXPECT_EQ(next_look(33, 1000), 64u);
    EXPECT_EQ(next_look(512, 1000), 1000u);
    EXPECT_EQ(next_look(0, 3), 3u);
    EXPECT_EQ(next_look(MAX_SPP / 2, MAX_SPP), MAX_SPP);
}

}  // namespace
}  // namespace candela
