// What the tests of textures' images share: reading them, their texels as numbers, and small files of each
// format.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <jpeglib.h>
#include <webp/encode.h>

#include "image/texel_io.h"
#include "unit/base/base_fixture.h"

namespace candela {

inline std::vector<uint8_t> random_bytes(size_t count, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::vector<uint8_t> bytes(count);
    for (uint8_t& byte : bytes)
        byte = uint8_t(random());
    return bytes;
}

// The texels of an image of 8 or 16 bits as integers, and of halves as their bits.
inline std::vector<uint32_t> texel_values(const TexelImage& image) {
    const size_t bytes = byte_size(image.type);
    std::vector<uint32_t> values(image.texels.size() / bytes);
    for (size_t i = 0; i < values.size(); ++i) {
        uint8_t narrow = 0;
        uint16_t wide = 0;
        if (bytes == 1) std::memcpy(&narrow, &image.texels[i], 1);
        if (bytes == 2) std::memcpy(&wide, &image.texels[2 * i], 2);
        values[i] = bytes == 1 ? narrow : wide;
    }
    return values;
}

// decode_texels() of a file that gives no warning.
inline TexelImage decode_quietly(const std::string& bytes, const std::string& name = "a") {
    std::vector<std::string> warnings;
    TexelImage image = decode_texels(bytes, name, warnings);
    EXPECT_EQ(warnings, std::vector<std::string>());
    return image;
}

// The only warning of a file that is used.
inline std::string texel_warning(const std::string& bytes, const std::string& name = "a") {
    std::vector<std::string> warnings;
    decode_texels(bytes, name, warnings);
    EXPECT_EQ(warnings.size(), 1u);
    return warnings.empty() ? "" : warnings.front();
}

// The message of a file that is refused, after `cannot read "a": `.
inline std::string texel_error(const std::string& bytes, const TexelLimits& limits = {}) {
    std::vector<std::string> warnings;
    const std::string message = error_of([&] { decode_texels(bytes, "a", warnings, limits); });
    const std::string start = "cannot read \"a\": ";
    EXPECT_EQ(message.substr(0, start.size()), start);
    return message.substr(std::min(start.size(), message.size()));
}

inline std::string damaged_file(const std::string& how) {
    return "the file is damaged or incomplete (" + how + "); write it again";
}

// Expects that a file is refused for a reason in the words of the library that decodes it, which differ
// between versions.
inline void expect_damaged(const std::string& bytes) {
    const std::string message = texel_error(bytes);
    EXPECT_TRUE(message.starts_with("the file is damaged or incomplete (") &&
                message.ends_with("); write it again"))
        << message;
}

// A JPEG file of the highest quality, of one channel or three. `adjust` may change libjpeg's defaults.
inline std::string encode_jpeg(
    uvec2 size, const std::vector<uint8_t>& samples, J_COLOR_SPACE space = JCS_GRAYSCALE,
    const std::function<void(j_compress_ptr)>& adjust = [](j_compress_ptr) {}) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);  // An error ends the test program.
    jpeg_create_compress(&jpeg);
    unsigned char* bytes = nullptr;
    unsigned long count = 0;
    jpeg_mem_dest(&jpeg, &bytes, &count);
    jpeg.image_width = size.x;
    jpeg.image_height = size.y;
    jpeg.input_components = int(samples.size() / size.x / size.y);
    jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    adjust(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    const size_t row_bytes = samples.size() / size.y;
    while (jpeg.next_scanline < size.y) {
        auto* row = const_cast<JSAMPROW>(&samples[jpeg.next_scanline * row_bytes]);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string file(reinterpret_cast<char*>(bytes), count);
    std::free(bytes);
    return file;
}

// A WebP file of RGB or RGBA, without loss or of that quality.
inline std::string encode_webp(uvec2 size, const std::vector<uint8_t>& samples, float lossy_quality = -1.0f) {
    WebPConfig config;
    WebPPicture picture;
    EXPECT_TRUE(WebPConfigInit(&config) && WebPPictureInit(&picture));
    if (lossy_quality < 0.0f) {
        config.lossless = 1;
        config.exact = 1;  // Also where nothing shows.
        picture.use_argb = 1;
    } else {
        config.quality = lossy_quality;
    }
    WebPMemoryWriter writer;
    WebPMemoryWriterInit(&writer);
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &writer;
    picture.width = int(size.x);
    picture.height = int(size.y);
    const auto stride = int(samples.size() / size.y);
    if (samples.size() == size_t{4} * size.x * size.y) {
        EXPECT_TRUE(WebPPictureImportRGBA(&picture, samples.data(), stride));
    } else {
        EXPECT_TRUE(WebPPictureImportRGB(&picture, samples.data(), stride));
    }
    EXPECT_TRUE(WebPEncode(&config, &picture));
    std::string file(reinterpret_cast<char*>(writer.mem), writer.size);
    WebPMemoryWriterClear(&writer);
    WebPPictureFree(&picture);
    return file;
}

}  // namespace candela
