// Reads Targa and BMP files with stb_image. stb_image reads zeros where a file ends early, and allocates as
// much as a header says, so headers and lengths are checked first. No other file includes stb_image.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#include <stb_image.h>

#include "image/image_io_parts.h"
#include "image/texel_io_parts.h"

namespace candela {
namespace {

uint32_t little_endian(std::string_view bytes, size_t at, size_t count) {
    uint32_t number = 0;
    for (size_t i = 0; i < count; ++i)
        number |= uint32_t(uint8_t(bytes[at + i])) << (8 * i);
    return number;
}

void check_size(const TexelSource& source, uvec2 size) {
    constexpr size_t MAX_BYTES = size_t{1} << 30;  // stb_image counts them in an int.
    check_pixel_count(source.name, size.x, size.y, source.limits.max_pixels);
    if (source.bytes.size() > MAX_BYTES) source.fail("it is larger than 1 GiB; convert it to PNG");
}

// Decodes a file that has been checked. With `drop_alpha`, RGBA becomes RGB.
TexelImage decode(const TexelSource& source, bool drop_alpha) {
    const auto* bytes = reinterpret_cast<const stbi_uc*>(source.bytes.data());
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, decltype(&std::free)> texels(
        stbi_load_from_memory(bytes, int(source.bytes.size()), &width, &height, &channels,
                              drop_alpha ? 3 : 0),
        &std::free);
    if (!texels) {
        const std::string reason = stbi_failure_reason();
        if (reason == "outofmem") throw std::bad_alloc();
        source.fail("stb_image says: " + reason + "; convert it to PNG");
    }
    TexelImage image =
        make_texels(uvec2(width, height), drop_alpha ? 3 : uint32_t(channels), TexelType::unorm8);
    std::memcpy(image.texels.data(), texels.get(), image.texels.size());
    return image;
}

// The header of a Targa file. Ref: Truevision, "TGA File Format Specification, Version 2.0" (1991).
struct TargaHeader {
    static constexpr size_t SIZE = 18;

    explicit TargaHeader(std::string_view bytes)
        : name_bytes(uint8_t(bytes[0])),
          has_palette(uint8_t(bytes[1])),
          type(uint8_t(bytes[2]) & 7u),
          packed(uint8_t(bytes[2]) & 8u),
          known_type((uint8_t(bytes[2]) & ~11u) == 0),
          first_color(little_endian(bytes, 3, 2)),
          colors(little_endian(bytes, 5, 2)),
          color_bits(uint8_t(bytes[7])),
          size(little_endian(bytes, 12, 2), little_endian(bytes, 14, 2)),
          bits(uint8_t(bytes[16])),
          flags(uint8_t(bytes[17])) {}

    // Whether these numbers are consistent; Targa files have no signature.
    bool is_plausible() const {
        constexpr uint32_t PALETTE = 1, RGB = 2, GREY = 3;
        const auto is_color = [](uint32_t b) { return b == 15 || b == 16 || b == 24 || b == 32; };
        const bool is_known = (type == PALETTE && (bits == 8 || bits == 16) && is_color(color_bits)) ||
                              (type == RGB && is_color(bits)) || (type == GREY && (bits == 8 || bits == 16));
        return known_type && is_known && has_palette == (type == PALETTE ? 1u : 0u) && size.x > 0 &&
               size.y > 0 && flags < 64;
    }
    size_t pixel_bytes() const { return (bits + 7) / 8; }
    // Offset of the pixels.
    size_t offset() const {
        return SIZE + name_bytes + size_t{has_palette} * colors * ((color_bits + 7) / 8);
    }

    uint32_t name_bytes, has_palette, type, packed;
    bool known_type;
    uint32_t first_color, colors, color_bits;
    uvec2 size;
    uint32_t bits, flags;
};

// Offset of the end of a Targa file's pixels; beyond its end if some are missing.
size_t end_of_pixels(std::string_view bytes, const TargaHeader& header) {
    uint64_t left = uint64_t{header.size.x} * header.size.y;
    if (header.packed == 0) return header.offset() + left * header.pixel_bytes();
    size_t at = header.offset();
    while (left > 0 && at < bytes.size()) {
        const auto packet = uint8_t(bytes[at]);
        const uint64_t pixels = 1 + (packet & 127u);
        at += 1 + (packet >= 128 ? 1 : pixels) * header.pixel_bytes();
        left -= std::min(left, pixels);
    }
    return left > 0 ? bytes.size() + 1 : at;
}

}  // namespace

bool is_targa(std::string_view bytes) {
    return bytes.size() >= TargaHeader::SIZE && TargaHeader(bytes).is_plausible();
}

TexelImage decode_targa_texels(const TexelSource& source) {
    constexpr uint32_t ALPHA_BITS = 15, FROM_THE_RIGHT = 16;
    const TargaHeader header(source.bytes);
    check_size(source, header.size);
    if ((header.flags & FROM_THE_RIGHT) != 0)
        source.fail("its rows run from right to left; convert it to PNG");
    if (header.first_color != 0) source.fail("its palette does not begin at 0; convert it to PNG");
    if (end_of_pixels(source.bytes, header) > source.bytes.size()) source.fail_too_short(header.size);
    return decode(source, header.bits == 32 && (header.flags & ALPHA_BITS) == 0);
}

// Ref: Microsoft, "Bitmap Storage", BITMAPFILEHEADER and BITMAPINFOHEADER.
TexelImage decode_bmp_texels(const TexelSource& source) {
    constexpr size_t FILE_HEADER = 14, OLD_HEADER = 12, NEW_HEADER = 40;
    constexpr uint32_t MASKS = 3;
    const std::string_view bytes = source.bytes;
    if (bytes.size() < FILE_HEADER + NEW_HEADER) source.fail_damaged("it ends in its header");
    const size_t offset = little_endian(bytes, 10, 4), header = little_endian(bytes, 14, 4);
    const bool is_old = header == OLD_HEADER;
    const size_t width = little_endian(bytes, 18, is_old ? 2 : 4);
    const auto rows = is_old ? int64_t{little_endian(bytes, 20, 2)}
                             : int64_t{int32_t(little_endian(bytes, 22, 4))};  // From below, or negative.
    const auto height = uint64_t(std::abs(rows));
    const size_t bits = little_endian(bytes, is_old ? 24 : 28, 2);
    const uint32_t compression = is_old ? 0 : little_endian(bytes, 30, 4);
    if (width < 1 || height < 1 || width > MAX_IMAGE_SIDE || height > MAX_IMAGE_SIDE) {
        source.fail_damaged("its header says " + std::to_string(width) + 'x' + std::to_string(height) +
                            " pixels");
    }
    check_size(source, uvec2(width, height));
    if (compression != 0 && compression != MASKS) source.fail("it is compressed; convert it to PNG");
    if (header > bytes.size() || offset > bytes.size() || offset < FILE_HEADER + header)
        source.fail_damaged("its header contradicts itself");
    if (offset + (width * bits + 31) / 32 * 4 * height > bytes.size())
        source.fail_too_short(uvec2(width, height));
    const size_t colors = (offset - FILE_HEADER - header) / (is_old ? 3 : 4);
    if (bits <= 8 && colors < size_t{1} << bits)
        source.fail("its palette has only " + std::to_string(colors) + " colours; convert it to PNG");
    return decode(source, false);
}

}  // namespace candela
