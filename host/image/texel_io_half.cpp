// Textures of 16-bit floats, from Radiance pictures and OpenEXR images.
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <half.h>

#include "base/printable.h"
#include "image/image_io.h"
#include "image/texel_io_parts.h"

namespace candela {
namespace {

constexpr float MAX_HALF = 65504.0f;

// Planes of a texture's channels, in their order.
using Planes = std::vector<std::span<const float>>;

// Makes halves of floats, and counts those that cannot stay as they are.
class HalfConverter {
  public:
    half convert(float value) {
        if (!std::isfinite(value) || value < 0.0f) {
            ++unusable_;
            return {0.0f};
        }
        if (value > MAX_HALF) {
            ++too_large_;
            return {MAX_HALF};
        }
        return {std::abs(value)};  // Makes -0 positive.
    }

    void report(const TexelSource& source, size_t total) const {
        const auto warn = [&](size_t count, const std::string& what, const char* result) {
            if (count == 0) return;
            source.warn(std::to_string(count) + " of " + std::to_string(total) + " values " +
                        (count == 1 ? "is " : "are ") + what + ", and " +
                        (count == 1 ? "becomes " : "become ") + result);
        };
        warn(unusable_, "negative or not finite", "0");
        warn(too_large_, "above 65504", "65504");
    }

  private:
    size_t unusable_ = 0;
    size_t too_large_ = 0;
};

// With `premultiplied`, the last plane is alpha, by which the others are divided.
TexelImage make_half_texels(const TexelSource& source, uvec2 size, const Planes& planes, bool premultiplied) {
    TexelImage image = make_texels(size, uint32_t(planes.size()), TexelType::half);
    HalfConverter converter;
    std::byte* out = image.texels.data();
    for (size_t i = 0; i < size_t{size.x} * size.y; ++i) {
        const float alpha = premultiplied ? planes.back()[i] : 1.0f;
        const float divisor = alpha > 0.0f && std::isfinite(alpha) ? alpha : 1.0f;
        for (size_t c = 0; c < planes.size(); ++c) {
            const bool is_alpha = premultiplied && c + 1 == planes.size();
            const half value = converter.convert(is_alpha ? alpha : planes[c][i] / divisor);
            const uint16_t bits = value.bits();
            std::memcpy(out, &bits, sizeof(bits));
            out += sizeof(bits);
        }
    }
    converter.report(source, size_t{size.x} * size.y * planes.size());
    return image;
}

// The planes of R, G and B, or of Y, and of A if there is one.
Planes find_planes(const TexelSource& source, const Image& image) {
    Planes planes;
    if (const auto rgb = image.find_rgb()) {
        planes.assign(rgb->begin(), rgb->end());
    } else if (const Channel* grey = image.find("Y")) {
        planes = {grey->values};
    } else {
        std::vector<std::string> names;
        for (const Channel& channel : image.channels)
            names.push_back(channel.name);
        source.fail("a texture needs the channels R, G and B, or Y, but the file has " + joined(names) +
                    "; write it with one of these");
    }
    if (const Channel* alpha = image.find("A")) planes.push_back(alpha->values);
    return planes;
}

}  // namespace

TexelImage decode_hdr_texels(const TexelSource& source) {
    const Image image =
        decode_hdr(source.bytes, source.name, {.max_pixels = source.limits.max_pixels, .channels = {}});
    return make_half_texels(source, image.full, find_planes(source, image), false);
}

TexelImage decode_exr_texels(const TexelSource& source) {
    const Image image =
        decode_exr(source.bytes, source.name,
                   {.max_pixels = source.limits.max_pixels, .channels = {"R", "G", "B", "Y", "A"}});
    if (image.data != PixelRect{0, 0, image.full.x, image.full.y}) {
        const auto size_text = [](uint32_t x, uint32_t y) {
            return std::to_string(x) + 'x' + std::to_string(y);
        };
        source.fail("a texture must be complete, but the file holds only " +
                    size_text(image.data.width(), image.data.height()) + " of its picture's " +
                    size_text(image.full.x, image.full.y) + " pixels; write all of it");
    }
    const Planes planes = find_planes(source, image);
    return make_half_texels(source, image.full, planes, image.find("A") != nullptr);
}

}  // namespace candela
