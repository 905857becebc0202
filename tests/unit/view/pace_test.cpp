// How coarse a moving picture is.
#include "view/pace.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace candela
