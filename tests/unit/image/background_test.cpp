// Images behind pictures: where their texels lie, how they are scaled, and what their codes mean.
#include "image/background.h"

#include <gtest/gtest.h>

#include "base/color.h"
#include "unit/base/base_fixture.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

TexelImage grey_image(uvec2 size, const std::vector<uint8_t>& codes) {
    const auto bytes = std::as_bytes(std::span(codes));
    return {.size = size,
            .channels = 1,
            .type = TexelType::unorm8,
            .texels = {bytes.begin(), bytes.end()},
            .gamma = {}};
}

// Reds of the background in a whole picture of that size.
std::vector<float> reds(const TexelImage& image, uvec2 full, PixelRect rect) {
    std::vector<float> result;
    for (const vec3 light : background_light(image, full, rect, Tonemap::linear, 1.0f))
        result.push_back(light.x);
    return result;
}
std::vector<float> reds(const TexelImage& image, uvec2 full) {
    return reds(image, full, {0, 0, full.x, full.y});
}

float light(uint8_t code) {
    return srgb_decode(float(code) / 255.0f);
}

void expect_lights(const std::vector<float>& actual, const std::vector<float>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (size_t i = 0; i < actual.size(); ++i)
        EXPECT_NEAR(actual[i], expected[i], 1e-6) << i;
}

TEST(Background, OfThePicturesSizeIsShownAsItIs) {
    const TexelImage image = grey_image({3, 2}, {0, 50, 100, 150, 200, 255});
    const std::vector<float> expected{light(0), light(50), light(100), light(150), light(200), 1.0f};
    expect_lights(reds(image, {3, 2}), expected);
    expect_lights(reds(image, {3, 2}, {1, 1, 3, 2}), {expected[4], expected[5]});
}

// Of 4 x 2 texels, a square picture shows the two columns in the middle; of 2 x 4, the two rows.
TEST(Background, CoversThePictureAndIsCutEvenly) {
    expect_lights(reds(grey_image({4, 2}, {1, 2, 3, 4, 5, 6, 7, 8}), {2, 2}),
                  {light(2), light(3), light(6), light(7)});
    expect_lights(reds(grey_image({2, 4}, {1, 2, 3, 4, 5, 6, 7, 8}), {2, 2}),
                  {light(3), light(4), light(5), light(6)});
}

// Between the middles of two texels light is linear; beyond, it is constant.
TEST(Background, IsEnlargedLinearlyInLight) {
    const float dark = light(10), bright = light(250);
    expect_lights(reds(grey_image({2, 1}, {10, 250}), {4, 2}),
                  {dark, 0.75f * dark + 0.25f * bright, 0.25f * dark + 0.75f * bright, bright,  //
                   dark, 0.75f * dark + 0.25f * bright, 0.25f * dark + 0.75f * bright, bright});
}

// A pixel of four texels, in the middle of the picture: a triangle over eight texels.
TEST(Background, IsShrunkByATriangleTwoPixelsWide) {
    std::vector<uint8_t> codes(12, 0);
    codes[3] = 255;  // 2.5 texels from the middle of the second pixel, at 6: 1 - 2.5 / 4, of a sum of 4.
    const std::vector<float> row =
        reds(grey_image({12, 4},
                        [&] {
                            std::vector<uint8_t> rows;
                            for (int y = 0; y < 4; ++y)
                                rows.insert(rows.end(), codes.begin(), codes.end());
                            return rows;
                        }()),
             {3, 1});
    EXPECT_NEAR(row[1], 0.375 / 4.0, 1e-6);
    EXPECT_EQ(row[2], 0.0f);
}

TEST(Background, HonoursGammaAndAlpha) {
    TexelImage image = grey_image({1, 1}, {128});
    image.gamma = 1.0;
    expect_lights(reds(image, {1, 1}), {128 / 255.0f});
    TexelImage veiled{.size = {1, 1},
                      .channels = 2,
                      .type = TexelType::unorm8,
                      .texels = {std::byte{255}, std::byte{51}},
                      .gamma = {}};
    expect_lights(reds(veiled, {1, 1}), {0.2f});
}

// Halves are light, and are developed as the picture is.
TEST(Background, OfHalvesIsDeveloped) {
    TexelImage image{.size = {1, 1}, .channels = 1, .type = TexelType::half, .texels = {}, .gamma = {}};
    image.texels = {std::byte{0x00}, std::byte{0x42}};  // 3.
    const auto shown = background_light(image, {1, 1}, {0, 0, 1, 1}, Tonemap::reinhard, 2.0f);
    EXPECT_NEAR(shown[0].x, 6.0 / 7.0, 1e-6);
}

}  // namespace
}  // namespace candela
