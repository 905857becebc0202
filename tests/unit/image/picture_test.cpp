// Pictures for the screen in files: what is written is what other decoders read, and what it states.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

#include "base/file.h"
#include "image/image_io.h"
#include "support/png_writer.h"
#include "unit/base/base_fixture.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

// A picture whose code of channel c at (x, y) is code(x, y, c).
template <class Code>
TexelImage picture_of(uvec2 size, uint32_t channels, TexelType type, const Code& code) {
    TexelImage picture{.size = size, .channels = channels, .type = type, .texels = {}, .gamma = {}};
    for (uint32_t y = 0; y < size.y; ++y) {
        for (uint32_t x = 0; x < size.x; ++x) {
            for (uint32_t c = 0; c < channels; ++c) {
                const uint16_t value = uint16_t(code(x, y, c));
                const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
                picture.texels.insert(picture.texels.end(), bytes, bytes + byte_size(type));
            }
        }
    }
    return picture;
}

class PictureTest : public testing::Test {
  protected:
    std::string written(const std::string& name, const TexelImage& picture,
                        const PictureNotes& notes = {}) const {
        write_picture(directory_ / name, picture, notes);
        return read_file(directory_ / name);
    }
    std::string error(const std::string& name, const TexelImage& picture) const {
        return error_of([&] { write_picture(name, picture); });
    }

    TemporaryDirectory directory_;
};

TEST_F(PictureTest, PngHoldsEveryCodeOfAnyDepthWithAlpha) {
    for (const TexelType type : {TexelType::unorm8, TexelType::unorm16}) {
        for (const uint32_t channels : {3u, 4u}) {
            SCOPED_TRACE(testing::Message() << byte_size(type) << ' ' << channels);
            const TexelImage picture =
                picture_of({37, 21}, channels, type, [&](uint32_t x, uint32_t y, uint32_t c) {
                    return (x * 2654435761u + y * 40503u + c * 977u) >> (type == TexelType::unorm8 ? 7 : 5);
                });
            const std::string file = written("a.png", picture);
            int width = 0, height = 0, components = 0;
            stbi_us* const decoded =
                stbi_load_16_from_memory(reinterpret_cast<const stbi_uc*>(file.data()), int(file.size()),
                                         &width, &height, &components, 0);
            ASSERT_NE(decoded, nullptr) << stbi_failure_reason();
            EXPECT_EQ(uvec2(width, height), picture.size);
            EXPECT_EQ(uint32_t(components), channels);
            std::vector<uint32_t> expected = texel_values(picture);
            for (uint32_t& code : expected)
                code *= type == TexelType::unorm8 ? 257 : 1;  // As the decoder widens bytes.
            EXPECT_EQ(std::vector<uint32_t>(decoded, decoded + expected.size()), expected);
            stbi_image_free(decoded);
        }
    }
}

TEST_F(PictureTest, AHeatmapsBytesAreAPngOfItsColours) {
    const std::vector<uint8_t> bytes = random_bytes(3 * 37 * 21);
    write_png(directory_ / "a.png", 37, 21, bytes);
    EXPECT_EQ(directory_.size(), 1);
    const TexelImage decoded = decode_quietly(read_file(directory_ / "a.png"));
    EXPECT_EQ(decoded.size, uvec2(37, 21));
    EXPECT_EQ(texel_values(decoded), (std::vector<uint32_t>(bytes.begin(), bytes.end())));
}

TEST_F(PictureTest, PngStatesItsColourSpaceAndTexts) {
    const TexelImage picture = picture_of({1, 1}, 3, TexelType::unorm8, [](auto...) { return 7; });
    const std::string file =
        written("a.png", picture, {.texts = {{"candela.seed", "7"}, {"gltf.copyright", "\xC2\xA9 me"}}});
    EXPECT_NE(file.find(png_chunk("sRGB", std::string(1, '\0'))), std::string::npos);
    EXPECT_NE(file.find(png_chunk("tEXt", std::string("candela.seed\0007", 14))), std::string::npos);
    // Not ASCII: name, neither compressed nor of a language, text.
    EXPECT_NE(file.find(png_chunk("iTXt", std::string("gltf.copyright\0\0\0\0\0\xC2\xA9 me", 24))),
              std::string::npos);
    EXPECT_EQ(written("b.png", picture).find("tEXt"), std::string::npos);
}

// A smooth picture: at the default quality, codes are off by a few steps at most.
TEST_F(PictureTest, JpegAndWebpHoldThePictureWithTheirLoss) {
    const auto code = [](uint32_t x, uint32_t y, uint32_t c) {
        return c == 0 ? 4 * x : c == 1 ? 4 * y : 128;
    };
    const TexelImage picture = picture_of({64, 64}, 3, TexelType::unorm8, code);
    const std::vector<uint32_t> expected = texel_values(picture);
    for (const char* name : {"a.jpg", "a.webp"}) {
        SCOPED_TRACE(name);
        const TexelImage decoded = decode_quietly(written(name, picture));
        ASSERT_EQ(decoded.size, picture.size);
        ASSERT_EQ(decoded.channels, 3u);
        double squares = 0.0;
        const std::vector<uint32_t> actual = texel_values(decoded);
        for (size_t i = 0; i < expected.size(); ++i)
            squares += std::pow(double(actual[i]) - double(expected[i]), 2.0);
        EXPECT_LT(std::sqrt(squares / double(expected.size())), 4.0);
        // Another quality is another size.
        EXPECT_LT(2 * written(name, picture, {.texts = {}, .quality = 10}).size(),
                  written(name, picture, {.texts = {}, .quality = 100}).size());
    }
}

TEST_F(PictureTest, WebpKeepsAlphaExactly) {
    const TexelImage picture =
        picture_of({16, 16}, 4, TexelType::unorm8,
                   [](uint32_t x, uint32_t y, uint32_t c) { return c == 3 ? 16 * y + x : 200; });
    const TexelImage decoded = decode_quietly(written("a.webp", picture));
    ASSERT_EQ(decoded.channels, 4u);
    const std::vector<uint32_t> values = texel_values(decoded);
    for (uint32_t i = 0; i < 256; ++i)
        EXPECT_EQ(values[4 * i + 3], i);
}

TEST_F(PictureTest, FormatsHaveALongestSide) {
    const TexelImage wide = picture_of({65501, 1}, 3, TexelType::unorm8, [](auto...) { return 0; });
    EXPECT_EQ(
        error("a.jpg", wide),
        "cannot write \"a.jpg\": a side of its 65501x1 pixels is longer than the 65500 of a JPEG file; write "
        "a PNG or EXR file");
    EXPECT_EQ(
        error("a.webp", wide),
        "cannot write \"a.webp\": a side of its 65501x1 pixels is longer than the 16383 of a WebP file; "
        "write a PNG or EXR file");
}

}  // namespace
}  // namespace candela
