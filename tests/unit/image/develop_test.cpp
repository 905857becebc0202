// Developing: exposure before the curve, what a picture shows before a background, and the exposure that
// fits.
#include "image/develop.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/color.h"
#include "unit/base/base_fixture.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

constexpr std::array<Tonemap, 5> CURVES = {Tonemap::linear, Tonemap::reinhard, Tonemap::aces, Tonemap::agx,
                                           Tonemap::neutral};
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
using Codes = std::vector<uint32_t>;

Image row_of(const std::vector<vec3>& pixels) {
    Image image;
    image.full = {uint32_t(pixels.size()), 1};
    image.data = {0, 0, image.full.x, 1};
    for (int c = 0; c < 3; ++c) {
        Channel& channel = image.add(std::string(1, "RGB"[c]));
        for (size_t i = 0; i < pixels.size(); ++i)
            channel.values[i] = pixels[i][c];
    }
    return image;
}

// A pixel of that premultiplied radiance, A and FirstHit.A.
Image pixel_of(vec3 colour, float alpha, float first_hit) {
    Image image = row_of({colour});
    image.add("A", alpha);
    image.add(FIRST_HIT_ALPHA, first_hit);
    return image;
}

Codes develop_codes(const Image& image, Tonemap curve = Tonemap::linear, float ev = 0.0f) {
    return texel_values(develop(image, {.curve = curve, .exposure_ev = ev}));
}

// The codes of 16 bits before a background.
Codes codes_before(const Background& background, const Image& image, Tonemap curve = Tonemap::linear,
                   float ev = 0.0f) {
    return texel_values(develop(
        image, {.curve = curve, .exposure_ev = ev, .type = TexelType::unorm16, .background = &background}));
}

double light_of(uint32_t code) {
    const double v = code / 65535.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// Half a code of 16 bits, and the roundings of floats on the way, as light.
constexpr double ROUNDING = 3e-5;

TEST(Develop, WorksPixelByPixelWithTheExposureFirst) {
    const Image image = row_of({{0.09f, 0.25f, 0.5f}, {0.0f, NOT_A_NUMBER, 3.0f}});
    EXPECT_EQ(develop_codes(image, Tonemap::linear, 1.0f), (Codes{118, 188, 255, 0, 0, 0}));
    const Image brighter = row_of({{0.36f, 1.0f, 2.0f}, vec3(0.0f)});
    for (const Tonemap curve : CURVES)
        EXPECT_EQ(develop_codes(image, curve, 2.0f), develop_codes(brighter, curve)) << int(curve);
}

TEST(Develop, ExtremeExposuresGiveBlackAndWhite) {
    const Image image = row_of({vec3(0.0f), vec3(1.0f)});
    EXPECT_EQ(develop_codes(image, Tonemap::linear, MAX_EXPOSURE_EV), (Codes{0, 0, 0, 255, 255, 255}));
    EXPECT_EQ(develop_codes(image, Tonemap::linear, -MAX_EXPOSURE_EV), Codes(6, 0));
}

TEST(Develop, RefusesAnImageWithoutColoursOrAlpha) {
    Image image = row_of({vec3(0.0f)});
    const Background background = Transparent{};
    EXPECT_EQ(error_of([&] { codes_before(background, image); }),
              "cannot put the image before a background: it lacks the channel A; render it");
    image.channels.pop_back();
    EXPECT_EQ(error_of([&] { develop(image, {}); }),
              "cannot develop the image: it lacks a channel R, G or B; render them");
}

TEST(Develop, SixteenBitsRoundToTheNearestCode) {
    const TexelImage picture = develop(row_of({{0.18f, 0.5f, 1.0f}}), {.type = TexelType::unorm16});
    // By the transfer function in double precision: 0.461356, 0.735357, 1.
    EXPECT_EQ(texel_values(picture), (Codes{30235, 48192, 65535}));
}

// An edge has the colour of what it belongs to, whatever the curve: not darker, as if black were behind.
TEST(Develop, EdgesHaveTheColourOfWhatTheyBelongTo) {
    const vec3 surface(0.9f, 0.4f, 0.1f);
    const Background background = Transparent{};
    for (const Tonemap curve : CURVES) {
        const Codes whole = codes_before(background, pixel_of(surface, 1.0f, 1.0f), curve, 0.5f);
        for (const float share : {0.75f, 0.25f, 0.0625f}) {
            const Codes edge = codes_before(background, pixel_of(share * surface, share, share), curve, 0.5f);
            for (size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(edge[c], whole[c], 1.0) << int(curve) << ' ' << share;
            EXPECT_NEAR(edge[3], 65535.0 * double(share), 0.5);
        }
    }
}

TEST(Develop, ABackgroundIsSeenAsFarAsAlphaLeavesIt) {
    const vec3 surface(0.9f, 0.4f, 0.1f), behind(0.25f, 0.5f, 1.0f);
    const Background background = behind;
    for (const Tonemap curve : CURVES) {
        const vec3 light = tonemap(curve, surface);
        for (const float share : {1.0f, 0.75f, 0.25f, 0.0f}) {
            const Codes codes = codes_before(background, pixel_of(share * surface, share, share), curve);
            ASSERT_EQ(codes.size(), 3u);
            for (int c = 0; c < 3; ++c) {
                const double expected =
                    double(share) * double(light[c]) + (1.0 - double(share)) * double(behind[c]);
                EXPECT_NEAR(light_of(codes[size_t(c)]), expected, ROUNDING) << int(curve) << ' ' << share;
            }
        }
    }
}

// A pane keeps 5 % of the background out, and reflects light of 0.2 or, from a lamp, 30.
TEST(Develop, ReflectionsInGlassKeepTheirLight) {
    const Background colour = vec3(0.5f), none = Transparent{};
    const Image pane = pixel_of(vec3(0.2f), 0.05f, 1.0f), lamp = pixel_of(vec3(30.0f), 0.05f, 1.0f);
    EXPECT_NEAR(light_of(codes_before(colour, pane)[0]), 0.2 + 0.95 * 0.5, ROUNDING);
    EXPECT_EQ(codes_before(colour, lamp), Codes(3, 65535));
    // Light 0.2 over nothing: white with that alpha. A lamp hides what is behind.
    const Codes alone = codes_before(none, pane);
    EXPECT_EQ(alone[0], 65535u);
    EXPECT_NEAR(alone[3], 0.2 * 65535, 1.0);
    EXPECT_EQ(codes_before(none, lamp), Codes(4, 65535));
    // A dark pane dims what is behind, with its own colour.
    const Codes dark = codes_before(none, pixel_of(vec3(0.1f, 0.0f, 0.0f), 0.4f, 1.0f));
    EXPECT_NEAR(light_of(dark[0]), 0.25, ROUNDING);
    EXPECT_NEAR(dark[3], 0.4 * 65535, 1.0);
}

TEST(Develop, NothingIsTransparentBlackOrTheBackgroundItself) {
    const Image nothing = pixel_of(vec3(0.0f), 0.0f, 0.0f);
    EXPECT_EQ(codes_before(Transparent{}, nothing), Codes(4, 0));
    const Background colour = vec3(srgb_decode(0x12 / 255.0f), srgb_decode(0xAB / 255.0f), 1.0f);
    for (const Tonemap curve : CURVES) {
        const TexelImage picture =
            develop(nothing, {.curve = curve, .exposure_ev = -3.0f, .background = &colour});
        EXPECT_EQ(texel_values(picture), (Codes{0x12, 0xAB, 0xFF})) << int(curve);
    }
    // Russian roulette lets a mean transmission exceed 1.
    EXPECT_EQ(codes_before(Transparent{}, pixel_of(vec3(0.0f), -0.01f, 1.0f)), Codes(4, 0));
    // What is not a number is black, as without a background.
    EXPECT_EQ(codes_before(Transparent{}, pixel_of(vec3(NOT_A_NUMBER), 1.0f, 1.0f)), (Codes{0, 0, 0, 65535}));
}

TEST(Develop, WithoutFirstHitsAlphaIsTheShare) {
    Image image = row_of({vec3(0.25f)});
    image.add("A", 0.5f);
    EXPECT_EQ(codes_before(Transparent{}, image),
              codes_before(Transparent{}, pixel_of(vec3(0.25f), 0.5f, 0.5f)));
}

// 100 pixels of the luminances 1 to 100: 95 of them are at most 95.
TEST(AutoExposure, BringsTheStatedPercentileToTheStatedLuminance) {
    std::vector<vec3> pixels;
    for (int i = 100; i > 0; --i)
        pixels.emplace_back(float(i));
    const double expected = std::log2(0.8 / 95.0);
    EXPECT_NEAR(auto_exposure(row_of(pixels)), expected, 1e-5);
    // Black, infinite and undefined pixels do not matter.
    pixels.insert(pixels.end(), 500, vec3(0.0f));
    pixels.insert(pixels.begin(), 50, vec3(INFINITE));
    pixels.insert(pixels.begin(), 50, vec3(NOT_A_NUMBER));
    EXPECT_NEAR(auto_exposure(row_of(pixels)), expected, 1e-5);
    EXPECT_NEAR(auto_exposure(row_of({{1.0f, 0.0f, 0.0f}})), std::log2(0.8 / 0.2126), 1e-5);
    EXPECT_EQ(auto_exposure(row_of({vec3(0.0f)})), 0.0f);
    EXPECT_EQ(auto_exposure(row_of({vec3(1e-35f)})), MAX_EXPOSURE_EV);
}

// Pixels of an edge are as bright as what they belong to, and weigh as much as they show of it.
TEST(AutoExposure, WeighsPixelsByTheirShare) {
    Image image = row_of({vec3(4.0f), vec3(0.5f)});
    image.add("A").values = {1.0f, 0.0625f};  // The second has the luminance 8, and 1/17 of the weight.
    EXPECT_NEAR(auto_exposure(image), std::log2(0.8 / 8.0), 1e-5);
    image.channels.back().values[1] = 0.03125f;  // The luminance 16, and 1/33 of the weight.
    EXPECT_NEAR(auto_exposure(image), std::log2(0.8 / 4.0), 1e-5);
}

}  // namespace
}  // namespace candela
