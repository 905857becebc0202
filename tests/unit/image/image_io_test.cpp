// Image files by their extensions.
#include "image/image_io.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "unit/base/base_fixture.h"
#include "unit/image/image_fixture.h"

namespace candela {
namespace {

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
    EXPECT_EQ(
        error_of([] { image_format("box.gif"); }),
        "image file \"box.gif\" has the unknown extension \".gif\" (supported: .exr, .png, .jpg, .webp)");
    EXPECT_EQ(error_of([] { image_format("out/exr"); }),
              "image file \"out/exr\" has no extension (supported: .exr, .png, .jpg, .webp)");
    EXPECT_EQ(error_of([] { image_format(".png"); }),
              "image file \".png\" has no extension (supported: .exr, .png, .jpg, .webp)");
    for (const char* name : {"a.jpg", "a.JPEG"})
        EXPECT_EQ(image_format(name), ImageFormat::jpeg);
    EXPECT_EQ(image_format("a.webp"), ImageFormat::webp);
    try {
        image_format("box.gif");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::request);
    }
}

}  // namespace
}  // namespace candela
