// Images made smaller: means over areas, of light if the image is encoded.
#include "image/shrink_image.h"

#include <cmath>
#include <cstring>
#include <vector>

#include <glm/packing.hpp>
#include <gtest/gtest.h>

#include "base/color.h"

namespace candela {
namespace {

TexelImage bytes(uvec2 size, uint32_t channels, const std::vector<uint8_t>& codes) {
    TexelImage image{
        .size = size, .channels = channels, .type = TexelType::unorm8, .texels = {}, .gamma = {}};
    for (const uint8_t code : codes)
        image.texels.push_back(std::byte(code));
    return image;
}

template <class Word>
TexelImage words(uvec2 size, uint32_t channels, TexelType type, const std::vector<Word>& codes) {
    TexelImage image{.size = size, .channels = channels, .type = type, .texels = {}, .gamma = {}};
    image.texels.resize(codes.size() * sizeof(Word));
    std::memcpy(image.texels.data(), codes.data(), image.texels.size());
    return image;
}

std::vector<uint8_t> codes_of(const TexelImage& image) {
    std::vector<uint8_t> codes;
    for (const std::byte b : image.texels)
        codes.push_back(std::to_integer<uint8_t>(b));
    return codes;
}

TEST(ShrinkImage, LeavesWhatIsSmallEnough) {
    const TexelImage image = bytes({3, 1}, 1, {1, 2, 3});
    EXPECT_EQ(codes_of(shrink(image, 3, TexelCodes::encoded)), codes_of(image));
    EXPECT_EQ(shrink(image, UINT32_MAX, TexelCodes::encoded).size, uvec2(3, 1));
}

// Four columns to two, two rows to one; colours and alpha by themselves.
TEST(ShrinkImage, ATexelIsTheMeanOfItsArea) {
    const TexelImage image =
        bytes({4, 2}, 2, {10, 0, 20, 100, 200, 255, 0, 255, 30, 50, 40, 50, 100, 255, 100, 255});
    const TexelImage small = shrink(image, 2, TexelCodes::linear);
    EXPECT_EQ(small.size, uvec2(2, 1));
    EXPECT_EQ(small.channels, 2u);
    EXPECT_EQ(codes_of(small), (std::vector<uint8_t>{25, 50, 100, 255}));
}

// Three texels to two: the middle one belongs to both by half.
TEST(ShrinkImage, TexelsAreDividedWhereSizesDoNotDivide) {
    const TexelImage small = shrink(bytes({1, 3}, 1, {30, 60, 120}), 2, TexelCodes::linear);
    EXPECT_EQ(small.size, uvec2(1, 2));
    EXPECT_EQ(codes_of(small), (std::vector<uint8_t>{40, 100}));
}

TEST(ShrinkImage, TheShorterSideStaysInProportionAndAtLeastOne) {
    EXPECT_EQ(shrink(bytes({6, 4}, 1, std::vector<uint8_t>(24)), 3, TexelCodes::linear).size, uvec2(3, 2));
    EXPECT_EQ(shrink(bytes({9, 1}, 1, std::vector<uint8_t>(9)), 2, TexelCodes::linear).size, uvec2(2, 1));
}

TEST(ShrinkImage, EncodedCodesAreAveragedAsLight) {
    const TexelImage image = bytes({2, 1}, 2, {0, 0, 255, 255});
    // Half of the light; alpha is linear always.
    const auto half = uint8_t(std::lround(255.0f * srgb_encode(0.5f)));
    EXPECT_EQ(codes_of(shrink(image, 1, TexelCodes::encoded)), (std::vector<uint8_t>{half, 128}));
    TexelImage gamma = image;
    gamma.gamma = 0.25;
    const auto root = uint8_t(std::lround(255.0 * std::pow(0.5, 0.25)));
    const TexelImage small = shrink(gamma, 1, TexelCodes::encoded);
    EXPECT_EQ(codes_of(small), (std::vector<uint8_t>{root, 128}));
    EXPECT_EQ(small.gamma, 0.25);
}

TEST(ShrinkImage, SixteenBitsAndHalvesStayWhatTheyAre) {
    const TexelImage deep =
        shrink(words<uint16_t>({2, 1}, 1, TexelType::unorm16, {1000, 3000}), 1, TexelCodes::linear);
    uint16_t code = 0;
    ASSERT_EQ(deep.texels.size(), sizeof code);
    std::memcpy(&code, deep.texels.data(), sizeof code);
    EXPECT_EQ(code, 2000);
    // Halves are light already.
    const auto half = [](float x) { return uint16_t(glm::packHalf2x16(glm::vec2(x, 0.0f))); };
    const TexelImage bright = shrink(words<uint16_t>({2, 1}, 1, TexelType::half, {half(1000.0f), half(3.0f)}),
                                     1, TexelCodes::encoded);
    std::memcpy(&code, bright.texels.data(), sizeof code);
    EXPECT_EQ(code, half(501.5f));
}

}  // namespace
}  // namespace candela
