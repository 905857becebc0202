// The kernel that develops the accumulation image for a window, against the host's development of image
// files.
#include "view/display.h"

#include <cmath>
#include <random>

#include "gpu/device_fixture.h"
#include "image/image.h"
#include "shared/constants.h"
#include "vk/transfer.h"

namespace candela {
namespace {

class DisplayTest : public DeviceTest {
  protected:
    // An accumulation image in which pixel i holds the sum of counts[i] samples of the colour colours[i].
    vk::StorageImage accumulation(uvec2 size, const std::vector<vec3>& colours,
                                  const std::vector<float>& counts) const {
        const size_t pixels = colours.size();
        std::vector<float> layers(pixels * 4 * 2);
        for (size_t i = 0; i < pixels; ++i) {
            for (int c = 0; c < 3; ++c)
                layers[4 * i + size_t(c)] = counts[i] * colours[i][c];
            layers[4 * (pixels + i) + 3] = counts[i];
        }
        vk::StorageImage image =
            vk::make_storage_image(device(), size.x, size.y, LAYER_COUNT_COLOUR, "accumulation");
        vk::upload(image, LAYER_L, layers);
        return image;
    }

    static std::vector<uint32_t> pixels_of(const Display& display, uvec2 size) {
        std::vector<uint32_t> pixels(size_t{size.x} * size.y);
        vk::download(display.screen(), std::as_writable_bytes(std::span(pixels)));
        return pixels;
    }
};

uint32_t word(std::array<uint8_t, 3> rgb) {
    return rgb[0] | uint32_t{rgb[1]} << 8 | uint32_t{rgb[2]} << 16 | 0xFF000000u;
}

// Vulkan allows exp2 and log2 errors of (3 + 2 |x|) and 3 units in the last place, and pow that of both
// together. With the exponents 1/2.4 and 2.2, and the cancellation in the matrices of ACES, encoded values
// differ by well below 1e-4. Rounding to 255 steps then differs, by one step, only where the value lies
// within 1e-4 * 255 of a step's middle: for 5 % of all values at most.
TEST_F(DisplayTest, DevelopsAsFilesAreDeveloped) {
    const uvec2 size(64, 64);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> exponent(-12.0f, 6.0f);
    std::vector<vec3> colours(size_t{size.x} * size.y);
    for (vec3& colour : colours)
        colour = vec3(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
    colours[0] = vec3(0.0f);
    colours[1] = vec3(1e30f);
    colours[2] = vec3(0.0f, 1e-20f, 5.0f);
    const vk::StorageImage image = accumulation(size, colours, std::vector<float>(colours.size(), 4.0f));
    Display display(device(), false);
    for (const Tonemap curve :
         {Tonemap::linear, Tonemap::reinhard, Tonemap::aces, Tonemap::agx, Tonemap::neutral}) {
        const float exposure = 0.75f;
        display.draw(image, size, curve, exposure, {});
        const std::vector<uint32_t> pixels = pixels_of(display, size);
        size_t different = 0;
        for (size_t i = 0; i < colours.size(); ++i) {
            const std::array<uint8_t, 3> codes =
                encode_srgb8(tonemap(curve, std::exp2(exposure) * colours[i]));
            for (size_t c = 0; c < 3; ++c) {
                const int difference = int(pixels[i] >> 8 * c & 255u) - int(codes[c]);
                ASSERT_LE(std::abs(difference), 1) << "curve " << int(curve) << ", pixel " << i;
                different += difference != 0;
            }
            ASSERT_EQ(pixels[i] >> 24, 255u);
        }
        EXPECT_LT(double(different), 0.05 * 3.0 * double(colours.size())) << "curve " << int(curve);
    }
}

// Half the pixels of the second image hold no sample yet.
TEST_F(DisplayTest, APixelWithoutSamplesShowsWhatItShowedBefore) {
    const uvec2 size(9, 5);
    const size_t pixels = size_t{size.x} * size.y;
    Display display(device(), false);
    std::vector<float> counts(pixels, 2.0f);
    display.draw(accumulation(size, std::vector<vec3>(pixels, vec3(1, 0, 0)), counts), size, Tonemap::linear,
                 0, {});
    for (size_t i = 0; i < pixels; i += 2)
        counts[i] = 0.0f;
    const vk::StorageImage second = accumulation(size, std::vector<vec3>(pixels, vec3(0, 1, 0)), counts);
    display.draw(second, size, Tonemap::linear, 0, {});
    const std::vector<uint32_t> shown = pixels_of(display, size);
    for (size_t i = 0; i < pixels; ++i)
        EXPECT_EQ(shown[i], i % 2 == 0 ? 0xFF0000FFu : 0xFF00FF00u) << i;

    const uvec2 other(5, 9);
    display.draw(accumulation(size, std::vector<vec3>(pixels, vec3(1)), std::vector<float>(pixels, 0.0f)),
                 other, Tonemap::linear, 0, {});
    for (const uint32_t pixel : pixels_of(display, other))
        EXPECT_EQ(pixel & 0xFFFFFFu, 0u);
}

// Code 100 under an overlay of code 64, alpha 1/4 (64/255): 64 + (1 - 64/255) 100 = 138.9.
TEST_F(DisplayTest, LaysTheOverlayOverItsRectangle) {
    const uvec2 size(20, 10);
    const size_t pixels = size_t{size.x} * size.y;
    float light = 0.0f;  // The least that is encoded as 100.
    while (encode_srgb8(vec3(light))[0] < 100)
        light += 1e-4f;
    const vk::StorageImage image =
        accumulation(size, std::vector<vec3>(pixels, vec3(light + 3e-4f)), std::vector<float>(pixels, 1.0f));
    const Overlay overlay{{3, 2, 8, 6}, std::vector<uint32_t>(20, 0x40404040u)};
    Display display(device(), false);
    display.draw(image, size, Tonemap::linear, 0, overlay);
    const std::vector<uint32_t> shown = pixels_of(display, size);
    for (uint32_t y = 0; y < size.y; ++y) {
        for (uint32_t x = 0; x < size.x; ++x) {
            const bool under = x >= 3 && x < 8 && y >= 2 && y < 6;
            EXPECT_EQ(shown[y * size.x + x] & 0xFFFFFFu, under ? 0x8B8B8Bu : 0x646464u) << x << ' ' << y;
        }
    }
    // Without the overlay, nothing of it is left.
    display.draw(image, size, Tonemap::linear, 0, {});
    EXPECT_EQ(pixels_of(display, size)[2 * size.x + 3] & 0xFFFFFFu, 0x646464u);
}

TEST_F(DisplayTest, StretchesASmallerImageAndOrdersTheBytesForTheWindow) {
    const uvec2 small(3, 2);
    const std::vector<vec3> colours{vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1),
                                    vec3(1, 1, 0), vec3(0, 1, 1), vec3(1, 0, 1)};
    const vk::StorageImage image = accumulation(small, colours, std::vector<float>(6, 1.0f));
    const uvec2 size(12, 6);
    Display red_first(device(), false);
    Display blue_first(device(), true);
    red_first.draw(image, size, Tonemap::linear, 0, {});
    blue_first.draw(image, size, Tonemap::linear, 0, {});
    const std::vector<uint32_t> red = pixels_of(red_first, size);
    const std::vector<uint32_t> blue = pixels_of(blue_first, size);
    for (uint32_t y = 0; y < size.y; ++y) {
        for (uint32_t x = 0; x < size.x; ++x) {
            const std::array<uint8_t, 3> rgb = encode_srgb8(colours[(y / 3) * 3 + x / 4]);
            EXPECT_EQ(red[y * size.x + x], word(rgb));
            EXPECT_EQ(blue[y * size.x + x], word({rgb[2], rgb[1], rgb[0]}));
        }
    }
}

}  // namespace
}  // namespace candela
