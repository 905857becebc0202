// PNG files, chunk by chunk and without compression, after the specification: no library takes part, so that
// tests can write what none would.
// Ref: W3C, "Portable Network Graphics (PNG) Specification (Second Edition)", 2003.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace candela {

inline const std::string PNG_SIGNATURE = "\x89PNG\r\n\x1a\n";

enum PngColor : uint8_t { png_grey = 0, png_rgb = 2, png_palette = 3, png_grey_alpha = 4, png_rgb_alpha = 6 };

// Samples of a picture (of a palette: indices), row-major from the top, channels interleaved.
struct PngPicture {
    uvec2 size;
    uint32_t bits;
    PngColor color;
    std::vector<uint32_t> samples{};

    uint32_t channels() const { return std::array{1u, 0u, 3u, 1u, 2u, 0u, 4u}[color]; }
};

inline std::string big_endian_bytes(uint32_t number) {
    return {char(number >> 24), char(number >> 16), char(number >> 8), char(number)};
}

// A chunk with its checksum.
inline std::string png_chunk(std::string_view type, std::string_view data) {
    const std::string body = std::string(type) + std::string(data);
    uint32_t crc = ~0u;
    for (const char byte : body) {
        crc ^= uint8_t(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 1) != 0 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return big_endian_bytes(uint32_t(data.size())) + body + big_endian_bytes(~crc);
}

// A zlib stream of stored blocks.
inline std::string zlib_stored(std::string_view data) {
    uint32_t a = 1, b = 0;
    for (const char byte : data) {
        a = (a + uint8_t(byte)) % 65521;
        b = (b + a) % 65521;
    }
    std::string stream = "\x78\x01";
    do {
        const std::string_view block = data.substr(0, 65535);
        data.remove_prefix(block.size());
        const auto size = uint16_t(block.size()), complement = uint16_t(~size);
        stream += {char(data.empty()), char(size), char(size >> 8), char(complement), char(complement >> 8)};
        stream += block;
    } while (!data.empty());
    return stream + big_endian_bytes(b << 16 | a);
}

// Rows of the pixels from `from` on, `step` apart, each of filter type 0 (none).
inline std::string png_rows(const PngPicture& picture, uvec2 from, uvec2 step) {
    std::string rows;
    if (from.x >= picture.size.x) return rows;
    for (uint32_t y = from.y; y < picture.size.y; y += step.y) {
        rows += '\0';
        uint32_t pending = 0, bits = 0;
        for (uint32_t x = from.x; x < picture.size.x; x += step.x) {
            for (uint32_t c = 0; c < picture.channels(); ++c) {
                const size_t pixel = size_t{y} * picture.size.x + x;
                pending = pending << picture.bits | picture.samples[pixel * picture.channels() + c];
                for (bits += picture.bits; bits >= 8; bits -= 8)
                    rows += char(pending >> (bits - 8));
            }
        }
        if (bits > 0) rows += char(pending << (8 - bits));
    }
    return rows;
}

inline std::string png_pixels(const PngPicture& picture, bool interlaced) {
    if (!interlaced) return png_rows(picture, {0, 0}, {1, 1});
    const std::array<std::array<uvec2, 2>, 7> passes{{{{{0, 0}, {8, 8}}},
                                                      {{{4, 0}, {8, 8}}},
                                                      {{{0, 4}, {4, 8}}},
                                                      {{{2, 0}, {4, 4}}},
                                                      {{{0, 2}, {2, 4}}},
                                                      {{{1, 0}, {2, 2}}},
                                                      {{{0, 1}, {1, 2}}}}};
    std::string rows;
    for (const auto& [from, step] : passes)
        rows += png_rows(picture, from, step);
    return rows;
}

inline std::string png_header(const PngPicture& picture, bool interlaced = false) {
    return png_chunk("IHDR",
                     big_endian_bytes(picture.size.x) + big_endian_bytes(picture.size.y) +
                         std::string{char(picture.bits), char(picture.color), 0, 0, char(interlaced)});
}

// The file, with these chunks between its header and its pixels.
inline std::string encode_png(const PngPicture& picture, const std::string& chunks = "",
                              bool interlaced = false) {
    return PNG_SIGNATURE + png_header(picture, interlaced) + chunks +
           png_chunk("IDAT", zlib_stored(png_pixels(picture, interlaced))) + png_chunk("IEND", "");
}

}  // namespace candela
