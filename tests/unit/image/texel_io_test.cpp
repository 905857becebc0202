// The formats of textures' files, the refused ones, and that damage causes only an Error.
#include <thread>

#include <gtest/gtest.h>

#include "base/file.h"
#include "image/image_io.h"
#include "support/png_writer.h"
#include "unit/image/image_fixture.h"
#include "unit/image/texel_fixture.h"

namespace candela {
namespace {

struct Sample {
    const char* kind;
    const char* extension;
    std::string bytes;
};

constexpr uvec2 SIZE{9, 10};

std::string exr_sample() {
    const TemporaryDirectory directory;
    Image image;
    image.full = SIZE;
    image.data = {0, 0, SIZE.x, SIZE.y};
    for (const char* name : {"R", "G", "B", "A"})
        image.add(name, 0.75f);
    write_exr(directory / "a.exr", image);
    return read_file(directory / "a.exr");
}

std::string hdr_sample() {
    std::string bytes = hdr_header(SIZE.x, SIZE.y);
    for (uint32_t i = 0; i < SIZE.x * SIZE.y; ++i)
        bytes += rgbe(200, int(i), 100, 128);
    return bytes;
}

// Small files of each format, and of each way in which it holds pixels.
const std::vector<Sample>& samples() {
    static const std::vector<Sample> SAMPLES = [] {
        const std::vector<uint8_t> noise = random_bytes(size_t{4} * SIZE.x * SIZE.y);
        const std::vector<uint8_t> rgb(noise.begin(), noise.end() - SIZE.x * SIZE.y);
        const PngPicture picture{
            .size = SIZE, .bits = 8, .color = png_palette, .samples = std::vector<uint32_t>(90, 1)};
        const std::string palette = png_chunk("PLTE", "abcdef") + png_chunk("tRNS", "gh");
        return std::vector<Sample>{
            {"a PNG image", ".png", encode_png(picture, palette)},
            {"a PNG image", ".png", encode_png(picture, palette, true)},
            {"a JPEG image", ".jpg", encode_jpeg(SIZE, rgb, JCS_RGB)},
            {"a JPEG image", ".jpeg", encode_jpeg(SIZE, rgb, JCS_RGB, jpeg_simple_progression)},
            {"a WebP image", ".webp", encode_webp(SIZE, noise)},
            {"a WebP image", ".webp", encode_webp(SIZE, noise, 50.0f)},
            {"a Radiance picture", ".hdr", hdr_sample()},
            {"an OpenEXR image", ".exr", exr_sample()}};
    }();
    return SAMPLES;
}

// Whether a damaged file is refused; if not, it gives an image of the same size.
bool is_refused(const std::string& bytes) {
    try {
        std::vector<std::string> warnings;
        const TexelImage image = decode_texels(bytes, "a", warnings, {.max_pixels = 1 << 16});
        EXPECT_EQ(image.texels.size(),
                  size_t{image.size.x} * image.size.y * image.channels * byte_size(image.type));
        return false;
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("cannot read \"a\": ")) << error.what();
        return true;
    }
}

TEST(TexelIo, TheFirstBytesSayWhatAFileIs) {
    const TemporaryDirectory directory;
    for (const Sample& sample : samples()) {
        for (const std::string extension : {"", ".data", ".png", ".JPG", ".jpeg", ".webp", ".hdr", ".exr"}) {
            const std::filesystem::path path = directory / ("a" + extension);
            write_quickly(path, sample.bytes);
            std::vector<std::string> warnings;
            EXPECT_EQ(decode_texels(read_file(path), path, warnings).size, SIZE);
            const std::string own = sample.extension == std::string(".jpeg") ? ".jpg" : sample.extension;
            const std::string lower = extension == ".JPG" || extension == ".jpeg" ? ".jpg" : extension;
            if (lower.empty() || lower == ".data" || lower == own) {
                EXPECT_TRUE(warnings.empty()) << sample.kind << extension;
            } else {
                EXPECT_EQ(warnings, std::vector<std::string>{path.string() + ": it is " + sample.kind +
                                                             ", despite its name, and is read as such"});
            }
        }
    }
}

TEST(TexelIo, SaysWhatAFileIsInstead) {
    using namespace std::string_literals;
    const std::string remedy = "; convert it to PNG, JPEG, WebP, Radiance HDR or OpenEXR";
    for (const auto& [bytes, kind] : std::vector<std::pair<std::string, std::string>>{
             {"GIF89a", "a GIF image"},
             {"GIF87a", "a GIF image"},
             {"II*\0"s, "a TIFF image"},
             {"MM\0*"s, "a TIFF image"},
             {"II+\0"s, "a TIFF image"},
             {"MM\0+"s, "a TIFF image"},
             {"8BPS", "a Photoshop document"},
             {"DDS |", "a DDS texture"},
             {"\xabKTX 11\xbb", "a KTX texture"},
             {"\0\0\0\x1c"
              "ftypavif"s,
              "an AVIF image"},
             {"\0\0\0\x1c"
              "ftypheic"s,
              "a HEIC image"},
             {"\0\0\0\x1c"
              "ftypmif1"s,
              "a HEIC image"},
             {"\0\0\0\x0cjP  \r\n\x87\n"s, "a JPEG 2000 image"},
             {"\xff\x4f\xff\x51", "a JPEG 2000 image"},
             {"\0\0\0\x0cJXL \r\n\x87\n"s, "a JPEG XL image"},
             {"\xff\x0a", "a JPEG XL image"},
             {"P6\n1 1\n255\nabc", "a PNM image"},
             {"<svg xmlns=", "an SVG drawing"},
             {"\xef\xbb\xbf<?xml version=", "an XML document, perhaps an SVG drawing"},
             {"\r\n\t <!DOCTYPE HTML>", "a web page"},
             {"<HTML><head>", "a web page"}}) {
        EXPECT_EQ(texel_error(bytes), "it is " + kind + remedy);
    }
    EXPECT_EQ(texel_error(""), "the file is empty; write it again");
    for (const std::string& bytes : {"\x89"s, "\xff"s, "RIFF\1\1\1\1WAVE"s, "   "s, "an image"s, "\0\0\0\0"s})
        EXPECT_EQ(texel_error(bytes),
                  "its first bytes are not those of an image that can be read; give PNG, "
                  "JPEG, WebP, Radiance HDR or OpenEXR");
}

TEST(TexelIo, RefusesMorePixelsThanAllowedBeforeItReadsThem) {
    for (const Sample& sample : samples()) {
        EXPECT_EQ(texel_error(sample.bytes.substr(0, sample.bytes.size() - 20), {.max_pixels = 89}),
                  "its 9x10 pixels are more than the 89 allowed here; make the image smaller")
            << sample.kind;
        std::vector<std::string> warnings;
        EXPECT_EQ(decode_texels(sample.bytes, "a", warnings, {.max_pixels = 90}).size, SIZE);
    }
}

// Wherever it is cut off; what follows the last pixel of an OpenEXR file may be missing.
TEST(TexelIo, EveryTruncatedFileIsRefused) {
    for (const Sample& sample : samples()) {
        for (size_t size = 0; size < sample.bytes.size(); ++size)
            ASSERT_TRUE(is_refused(sample.bytes.substr(0, size))) << sample.kind << ' ' << size;
    }
}

TEST(TexelIo, EveryChangedByteIsUsedOrRefused) {
    for (const Sample& sample : samples()) {
        size_t refused = 0;
        for (size_t i = 0; i < sample.bytes.size(); ++i) {
            for (const char change : {'\x01', '\x80', '\xff'}) {
                std::string bytes = sample.bytes;
                bytes[i] = char(bytes[i] ^ change);
                refused += is_refused(bytes) ? 1 : 0;
            }
        }
        // Every byte of a PNG file affects one of its checksums.
        const bool is_png = sample.kind == std::string("a PNG image");
        EXPECT_GE(refused, is_png ? 3 * sample.bytes.size() : 20u) << sample.kind;
    }
}

TEST(TexelIo, ThreadsDoNotDisturbEachOther) {
    std::vector<std::vector<std::byte>> expected;
    for (const Sample& sample : samples())
        expected.push_back(decode_quietly(sample.bytes).texels);
    std::vector<std::thread> threads;
    for (size_t t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            for (size_t i = 0; i < 200; ++i) {
                const size_t sample = (i + t) % samples().size();
                if (i % 3 == 0) is_refused(samples()[sample].bytes.substr(0, 60));
                EXPECT_EQ(decode_quietly(samples()[sample].bytes).texels, expected[sample]);
            }
        });
    }
    for (std::thread& thread : threads)
        thread.join();
}

}  // namespace
}  // namespace candela
