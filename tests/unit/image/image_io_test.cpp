// Image files by their extensions, and PNG files: what is written is what another decoder reads.
#include "image/image_io.h"

#include <random>

#include <gtest/gtest.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

#include "base/file.h"
#include "unit/base/base_fixture.h"
#include "unit/image/image_fixture.h"

namespace candela {
namespace {

TEST(ImageIo, PngHoldsThePixels) {
    const TemporaryDirectory directory;
    std::mt19937 random(4);
    std::vector<uint8_t> pixels(3 * 37 * 21);
    for (size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = uint8_t(i / 9 + random() % 5);
    write_png(directory / "a.png", 37, 21, pixels);
    EXPECT_EQ(directory.size(), 1);
    const std::string file = read_file(directory / "a.png");
    int width = 0;
    int height = 0;
    int components = 0;
    stbi_uc* decoded = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(file.data()), int(file.size()),
                                             &width, &height, &components, 0);
    ASSERT_NE(decoded, nullptr) << stbi_failure_reason();
    EXPECT_EQ(width, 37);
    EXPECT_EQ(height, 21);
    EXPECT_EQ(components, 3);
    EXPECT_EQ(std::vector<uint8_t>(decoded, decoded + pixels.size()), pixels);
    stbi_image_free(decoded);
}

TEST(ImageIo, RefusesAPngThatTheEncoderCannotCount) {
    const uint32_t side = 18'920;  // 3 * 18920^2 bytes are a little more than 2^30, never touched here.
    const std::span<const uint8_t> pixels(static_cast<const uint8_t*>(nullptr), size_t(3) * side * side);
    EXPECT_EQ(
        error_of([&] { write_png("a.png", side, side, pixels); }),
        "cannot write \"a.png\": 18920x18920 pixels are too many for the PNG encoder; write an EXR file");
}

TEST(ImageIo, ReportsAnUnwritablePlace) {
    EXPECT_EQ(error_of([] { write_png("/none/a.png", 1, 1, std::vector<uint8_t>(3)); }),
              "cannot write \"/none/a.png\": the directory \"/none\" does not exist; create it first");
}

TEST(ImageIo, ReadsTheFormatsThatItKnowsByExtension) {
    const TemporaryDirectory directory;
    Image image;
    image.full = {2, 1};
    image.data = {0, 0, 2, 1};
    image.add("Z", 7.0f);
    write_exr(directory / "a.EXR", image);
    const auto read_image = [&](const std::string& name, const ImageLimits& limits = {}) {
        return decode_image(read_file(directory / name), name, limits);
    };
    EXPECT_EQ(read_image("a.EXR").channels[0].name, "Z");
    for (const char* name : {"a.hdr", "a.HDR", "a.pic"}) {
        write_quickly(directory / name, hdr_header(1, 1) + rgbe(128, 0, 0, 129));
        EXPECT_EQ(read_image(name).find("R")->values[0], 1.0f);
    }
    // The limit on pixels reaches the readers.
    EXPECT_NE(
        error_of([&] { read_image("a.EXR", {.max_pixels = 1}); }).find("2x1 pixels are more than the 1"),
        std::string::npos);
    EXPECT_NE(
        error_of([&] { read_image("a.hdr", {.max_pixels = 0}); }).find("1x1 pixels are more than the 0"),
        std::string::npos);
    // What the file holds decides, not its name.
    write_exr(directory / "b.hdr", image);
    EXPECT_EQ(read_image("b.hdr").channels[0].name, "Z");
    for (const char* text : {"", "\x89PNG\r\n", "ply\n"}) {
        EXPECT_EQ(error_of([&] { decode_image(text, "c.exr"); }),
                  "cannot read \"c.exr\": it is neither an OpenEXR image nor a Radiance picture; give an "
                  ".exr or .hdr image");
    }
}

TEST(ImageIo, KnowsFormatsByExtension) {
    EXPECT_EQ(image_format("a.exr"), ImageFormat::exr);
    EXPECT_EQ(image_format("dir.png/a.EXR"), ImageFormat::exr);
    EXPECT_EQ(image_format("a.exr.Png"), ImageFormat::png);
    EXPECT_EQ(error_of([] { image_format("box.jpg"); }),
              "image file \"box.jpg\" has the unknown extension \".jpg\" (supported: .exr, .png)");
    EXPECT_EQ(error_of([] { image_format("out/exr"); }),
              "image file \"out/exr\" has no extension (supported: .exr, .png)");
    EXPECT_EQ(error_of([] { image_format(".png"); }),
              "image file \".png\" has no extension (supported: .exr, .png)");
    try {
        image_format("box.jpg");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::request);
    }
}

}  // namespace
}  // namespace candela
