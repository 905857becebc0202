// The images of textures in memory: texels as a file holds them, at one of three precisions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/math.h"

namespace candela {

// How a channel of a texel is stored: as an integer, from 0 for 0 to 255 or 65535 for 1, or as a 16-bit
// float.
enum class TexelType { unorm8, unorm16, half };

// The bytes of a channel of a texel.
constexpr size_t byte_size(TexelType type) {
    return type == TexelType::unorm8 ? 1 : 2;
}

// Texels, row-major from the top, channels interleaved, in the machine's byte order. The file does not
// determine what the values mean (sRGB, linear light, a normal).
struct TexelImage {
    uvec2 size{0};          // Each at least 1, once read.
    uint32_t channels = 0;  // 1: grey; 2: grey, alpha; 3: RGB; 4: RGBA. Alpha is straight, not premultiplied.
    TexelType type = TexelType::unorm8;
    std::vector<std::byte> texels;  // size.x * size.y * channels * byte_size(type).
    // The gamma of a PNG file that states one, other than sRGB or about 1/2.2: sample = light^gamma, both
    // from 0 to 1. Between 0.1 and 10.
    std::optional<double> gamma;
};

// Red, green, blue and alpha of texel i, row-major from the top: the numbers of the file, from 0 to 1 unless
// they are halves. Alpha is 1 where the image has none.
vec4 texel_codes(const TexelImage& image, size_t i);

}  // namespace candela
