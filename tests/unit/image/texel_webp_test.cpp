// WebP files as textures.
#include <cmath>

#include <gtest/gtest.h>

#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

constexpr uvec2 WEBP_SIZE{37, 23};

void expect_samples(const TexelImage& image, uint32_t channels, const std::vector<uint8_t>& samples) {
    EXPECT_EQ(image.size, WEBP_SIZE);
    EXPECT_EQ(image.channels, channels);
    EXPECT_EQ(image.type, TexelType::unorm8);
    EXPECT_EQ(image.gamma, std::nullopt);
    EXPECT_EQ(texel_values(image), std::vector<uint32_t>(samples.begin(), samples.end()));
}

TEST(TexelWebp, LosslessFilesGiveTheirSamples) {
    for (const uint32_t channels : {3u, 4u}) {
        const std::vector<uint8_t> samples = random_bytes(size_t{channels} * WEBP_SIZE.x * WEBP_SIZE.y);
        expect_samples(decode_quietly(encode_webp(WEBP_SIZE, samples)), channels, samples);
    }
}

// One colour survives the transforms but for the rounding of Y, Cb and Cr, which have the range of
// television: up to 1/2 each times 255/219 and 2.018 at most, and of the result; and half a step of the
// coarsest quantiser at this quality. Alpha is stored without loss.
TEST(TexelWebp, LossyFilesGiveNearlyTheirColoursAndExactlyTheirAlpha) {
    for (const uint32_t channels : {3u, 4u}) {
        std::vector<uint8_t> samples = random_bytes(size_t{channels} * WEBP_SIZE.x * WEBP_SIZE.y);
        for (size_t i = 0; i < samples.size(); i += channels) {
            samples[i] = 200;
            samples[i + 1] = 100;
            samples[i + 2] = 50;
            if (channels == 4) samples[i + 3] = uint8_t(1 + samples[i + 3] % 255);
        }
        const TexelImage image = decode_quietly(encode_webp(WEBP_SIZE, samples, 100.0f));
        ASSERT_EQ(image.channels, channels);
        const std::vector<uint32_t> values = texel_values(image);
        ASSERT_EQ(values.size(), samples.size());
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_NEAR(int(values[i]), int(samples[i]), i % channels == 3 ? 0 : 4) << i;
    }
}

std::string riff(const std::string& chunks) {
    const auto size = uint32_t(chunks.size() + 4);
    return "RIFF" + std::string{char(size), char(size >> 8), char(size >> 16), char(size >> 24)} + "WEBP" +
           chunks;
}

TEST(TexelWebp, RefusesAnAnimation) {
    const std::string header = std::string("VP8X\x0a\0\0\0\x02\0\0\0\x24\0\0\x16\0\0", 18);
    const std::string animation = std::string("ANIM\x06\0\0\0\0\0\0\0\0\0", 14);
    EXPECT_EQ(texel_error(riff(header + animation)),
              "it is an animation; save its first frame as an image of its own");
}

TEST(TexelWebp, SaysWhatIsDamaged) {
    for (const float quality : {-1.0f, 90.0f}) {
        const std::string file =
            encode_webp(WEBP_SIZE, random_bytes(size_t{4} * WEBP_SIZE.x * WEBP_SIZE.y), quality);
        EXPECT_EQ(texel_error(file.substr(0, file.size() - 1)), damaged_file("it ends early"));
        EXPECT_EQ(texel_error(file.substr(0, 12)), damaged_file("it ends early"));
        EXPECT_EQ(texel_error(riff("abcdefghijklmnopqrstuvwxyz")),
                  damaged_file("its bytes are not valid WebP"));
    }
    EXPECT_EQ(texel_error("XXXX" + riff("VP8 ").substr(4)), damaged_file("its bytes are not valid WebP"));
}

}  // namespace
}  // namespace candela
