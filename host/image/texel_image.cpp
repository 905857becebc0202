// See texel_image.h.
#include "image/texel_image.h"

#include <cstring>

#include <glm/packing.hpp>

namespace candela {

static float decode(const std::byte* code, TexelType type) {
    if (type == TexelType::unorm8) return float(std::to_integer<unsigned>(*code)) / 255.0f;
    uint16_t word = 0;
    std::memcpy(&word, code, sizeof word);
    return type == TexelType::half ? glm::unpackHalf2x16(word).x : float(word) / 65535.0f;
}

vec4 texel_codes(const TexelImage& image, size_t i) {
    const size_t bytes = byte_size(image.type);
    const std::byte* texel = image.texels.data() + i * image.channels * bytes;
    const auto code = [&](uint32_t channel) { return decode(texel + channel * bytes, image.type); };
    const bool is_grey = image.channels < 3;
    const float alpha = image.channels % 2 == 0 ? code(image.channels - 1) : 1.0f;
    return {code(0), code(is_grey ? 0 : 1), code(is_grey ? 0 : 2), alpha};
}

}  // namespace candela
