// Radiance pictures and OpenEXR images as textures of halves.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <half.h>

#include "base/file.h"
#include "image/image_io.h"
#include "unit/image/image_fixture.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

// The values of an image of halves.
std::vector<float> half_values(const TexelImage& image) {
    EXPECT_EQ(image.type, TexelType::half);
    std::vector<float> values;
    for (const uint32_t bits : texel_values(image)) {
        half value;
        value.setBits(uint16_t(bits));
        values.push_back(value);
    }
    return values;
}

struct Plane {
    const char* name;
    std::vector<float> values;
};

// One row of pixels.
Image make_row(const std::vector<Plane>& planes) {
    Image image;
    image.full = {planes.front().values.size(), 1};
    image.data = {0, 0, image.full.x, 1};
    for (const auto& [name, values] : planes)
        image.add(name).values = values;
    return image;
}

class TexelHalf : public testing::Test {
  protected:
    std::string exr(const Image& image) {
        write_exr(path_, image);
        return read_file(path_);
    }

    TemporaryDirectory directory_;
    std::filesystem::path path_ = directory_ / "a.exr";
};

TEST_F(TexelHalf, RadianceGivesThreeChannels) {
    // Mantissas count 2^(e - 136).
    const std::string file = hdr_header(2, 1) + rgbe(128, 64, 3, 129) + rgbe(1, 200, 255, 136);
    const TexelImage image = decode_quietly(file);
    EXPECT_EQ(image.size, uvec2(2, 1));
    EXPECT_EQ(image.channels, 3u);
    EXPECT_EQ(half_values(image), (std::vector<float>{1.0f, 0.5f, 3.0f / 128.0f, 1.0f, 200.0f, 255.0f}));
}

TEST_F(TexelHalf, OpenExrGivesItsChannels) {
    const Plane r{"R", {1.0f, 2.0f}}, g{"G", {0.5f, 0.25f}}, b{"B", {8.0f, 0.0f}}, y{"Y", {3.0f, 4.0f}};
    const Plane one{"A", {1.0f, 1.0f}}, other{"Z", {9.0f, 9.0f}};
    const auto read = [&](const std::vector<Plane>& planes, uint32_t channels) {
        const TexelImage image = decode_quietly(exr(make_row(planes)));
        EXPECT_EQ(image.size, uvec2(2, 1));
        EXPECT_EQ(image.channels, channels);
        return half_values(image);
    };
    EXPECT_EQ(read({r, g, b, other}, 3), (std::vector{1.0f, 0.5f, 8.0f, 2.0f, 0.25f, 0.0f}));
    EXPECT_EQ(read({r, g, b, one}, 4), (std::vector{1.0f, 0.5f, 8.0f, 1.0f, 2.0f, 0.25f, 0.0f, 1.0f}));
    EXPECT_EQ(read({y, other}, 1), (std::vector{3.0f, 4.0f}));
    EXPECT_EQ(read({y, one}, 2), (std::vector{3.0f, 1.0f, 4.0f, 1.0f}));
    EXPECT_EQ(read({y, r, g, b}, 3), (std::vector{1.0f, 0.5f, 8.0f, 2.0f, 0.25f, 0.0f}));
}

TEST_F(TexelHalf, ColoursAreDividedByAlphaWhereverItIsAboveZero) {
    const TexelImage image =
        decode_quietly(exr(make_row({{"Y", {0.25f, 0.25f, 3.0f, 4.0f}}, {"A", {0.5f, 1.0f, 0.0f, 2.0f}}})));
    EXPECT_EQ(half_values(image), (std::vector{0.5f, 0.5f, 0.25f, 1.0f, 3.0f, 0.0f, 2.0f, 2.0f}));
}

TEST_F(TexelHalf, EveryHalfSurvivesAndOthersAreRoundedToTheNearest) {
    std::vector<float> values;
    for (uint32_t bits = 0; bits < 0x7c00; ++bits) {
        half value;
        value.setBits(uint16_t(bits));
        values.push_back(value);
    }
    EXPECT_EQ(half_values(decode_quietly(exr(make_row({{"Y", values}})))), values);
    std::vector<float> above, below, middle;  // Between neighbours, nearer to the lower or the upper one.
    for (size_t i = 0; i + 1 < values.size(); ++i) {
        above.push_back(std::lerp(values[i], values[i + 1], 0.375f));
        below.push_back(std::lerp(values[i], values[i + 1], 0.625f));
    }
    EXPECT_EQ(half_values(decode_quietly(exr(make_row({{"Y", above}})))),
              (std::vector(values.begin(), values.end() - 1)));
    EXPECT_EQ(half_values(decode_quietly(exr(make_row({{"Y", below}})))),
              (std::vector(values.begin() + 1, values.end())));
}

TEST_F(TexelHalf, WhatAHalfCannotHoldIsCounted) {
    constexpr float NAN_VALUE = std::numeric_limits<float>::quiet_NaN();
    std::vector<std::string> warnings;
    const Plane values{"Y", {65504.0f, 65505.0f, 1e30f, INFINITE, -INFINITE, NAN_VALUE, -1.0f, -0.0f}};
    const TexelImage image = decode_texels(exr(make_row({values})), "a", warnings);
    EXPECT_EQ(texel_values(image), (std::vector<uint32_t>{0x7bff, 0x7bff, 0x7bff, 0, 0, 0, 0, 0}));
    EXPECT_EQ(warnings, (std::vector<std::string>{"a: 4 of 8 values are negative or not finite, and become 0",
                                                  "a: 2 of 8 values are above 65504, and become 65504"}));
    EXPECT_EQ(texel_warning(exr(make_row({{"Y", {1.0f, 1e30f}}}))),
              "a: 1 of 2 values is above 65504, and becomes 65504");
    // 255 * 2^(144 - 136) = 65280; twice that is too large.
    EXPECT_EQ(half_values(decode_quietly(hdr_header(1, 1) + rgbe(255, 0, 0, 144)))[0], 65280.0f);
    EXPECT_EQ(texel_warning(hdr_header(1, 1) + rgbe(255, 0, 0, 145)),
              "a: 1 of 3 values is above 65504, and becomes 65504");
}

TEST_F(TexelHalf, AnAlphaThatIsNoNumberBecomesZeroAndDividesNothing) {
    std::vector<std::string> warnings;
    const TexelImage image = decode_texels(
        exr(make_row({{"Y", {0.5f, 0.5f, 0.5f}}, {"A", {INFINITE, -1.0f, NAN}}})), "a", warnings);
    EXPECT_EQ(half_values(image), (std::vector{0.5f, 0.0f, 0.5f, 0.0f, 0.5f, 0.0f}));
    EXPECT_EQ(warnings,
              std::vector<std::string>{"a: 3 of 6 values are negative or not finite, and become 0"});
}

TEST_F(TexelHalf, SaysWhatIsNoTexture) {
    EXPECT_EQ(
        texel_error(exr(make_row({{"R", {1.0f}}, {"Z", {1.0f}}}))),
        "a texture needs the channels R, G and B, or Y, but the file has R, Z; write it with one of these");
    Image part = make_row({{"Y", {1.0f, 2.0f}}});
    part.full = {3, 2};
    EXPECT_EQ(
        texel_error(exr(part)),
        "a texture must be complete, but the file holds only 2x1 of its picture's 3x2 pixels; write all of "
        "it");
    EXPECT_EQ(texel_error(hdr_header(1, 1)), damaged_file("it ends in row 1"));
    EXPECT_EQ(texel_error(exr(make_row({{"Y", {1.0f}}})).substr(0, 20)).substr(0, 34),
              "the file is damaged or incomplete ");
}

}  // namespace
}  // namespace candela
