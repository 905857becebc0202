// The table of 8-bit codes against the definition of sRGB in double precision.
#include "image/srgb_codes.h"

#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "base/math.h"

namespace candela {
namespace {

const SrgbCodes& srgb_code = SrgbCodes::table();

// Ref: IEC 61966-2-1.
double srgb(double light) {
    return light > 0.0031308 ? 1.055 * std::pow(light, 1 / 2.4) - 0.055 : 12.92 * light;
}

// A code is at most half of one away, and what the float of the power, near 1, rounds: three units of 2^-24
// each.
constexpr double LARGEST_DISTANCE = 0.5 + 255 * 3 * 0x1p-24;

void expect_nearest(float light) {
    ASSERT_NEAR(srgb_code(light), 255 * srgb(double(light)), LARGEST_DISTANCE) << light;
}

TEST(SrgbCodes, AreTheNearest) {
    const auto one = std::bit_cast<uint32_t>(1.0f);
    for (uint32_t bits = 0; bits < one; bits += 1009)
        expect_nearest(std::bit_cast<float>(bits));
    // Around the light where codes change.
    for (int code = 1; code <= 255; ++code) {
        const double encoded = (code - 0.5) / 255;
        const double light = encoded > 0.04045 ? std::pow((encoded + 0.055) / 1.055, 2.4) : encoded / 12.92;
        for (const double factor : {1 - 1e-5, 1 - 1e-7, 1.0, 1 + 1e-7, 1 + 1e-5})
            expect_nearest(float(light * factor));
        EXPECT_EQ(srgb_code(float(light * (1 - 1e-5))), code - 1);
        EXPECT_EQ(srgb_code(float(light * (1 + 1e-5))), code);
    }
}

TEST(SrgbCodes, EndAtBlackAndWhite) {
    for (const float black : {0.0f, -1.0f, -INFINITE, std::nanf("")})
        EXPECT_EQ(srgb_code(black), 0);
    for (const float white : {1.0f, 2.0f, INFINITE})
        EXPECT_EQ(srgb_code(white), 255);
}

}  // namespace
}  // namespace candela
