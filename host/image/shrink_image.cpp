// See shrink_image.h.
#include "image/shrink_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include <glm/packing.hpp>

#include "base/color.h"

namespace candela {
namespace {

// The value that is averaged, for every code of a channel.
class Scale {
  public:
    // `gamma` as in TexelImage; `encoded`: codes are averaged as light.
    Scale(TexelType type, std::optional<double> gamma, bool encoded)
        : type_(type), gamma_(gamma), encoded_(encoded && type != TexelType::half) {
        values_.resize(type == TexelType::unorm8 ? 0x100 : 0x10000);
        for (uint32_t i = 0; i < values_.size(); ++i)
            values_[i] = type == TexelType::half ? glm::unpackHalf2x16(i).x : decode(float(i) / greatest());
    }

    // The value of the code at `place`.
    float read(const std::byte* place) const {
        if (type_ == TexelType::unorm8) return values_[std::to_integer<size_t>(*place)];
        uint16_t code = 0;
        std::memcpy(&code, place, sizeof code);
        return values_[code];
    }

    // Writes the code whose value is nearest.
    void write(std::byte* place, double value) const {
        if (type_ == TexelType::unorm8) {
            *place = std::byte(std::lround(encode(float(value)) * greatest()));
            return;
        }
        const auto code = type_ == TexelType::half
                              ? uint16_t(glm::packHalf2x16(glm::vec2(float(value), 0.0f)))
                              : uint16_t(std::lround(encode(float(value)) * greatest()));
        std::memcpy(place, &code, sizeof code);
    }

  private:
    float greatest() const { return type_ == TexelType::unorm8 ? 255.0f : 65535.0f; }
    float decode(float code) const {
        if (!encoded_) return code;
        return gamma_ ? std::pow(code, float(1.0 / *gamma_)) : srgb_decode(code);
    }
    float encode(float value) const {
        if (!encoded_) return value;
        return std::min(gamma_ ? std::pow(value, float(*gamma_)) : srgb_encode(value), 1.0f);
    }

    TexelType type_;
    std::optional<double> gamma_;
    bool encoded_;
    std::vector<float> values_;
};

// The part of an axis that a texel of the smaller image covers, in texels of the larger one.
struct Stretch {
    Stretch(uint32_t i, uint32_t small, uint32_t large)
        : begin(double(i) * large / small), end(double(i + 1) * large / small) {}

    uint32_t first() const { return uint32_t(begin); }
    // One beyond the last; `large` is the length of the axis.
    uint32_t last(uint32_t large) const { return std::min(uint32_t(std::ceil(end)), large); }
    double weight(uint32_t texel) const {
        return (std::min(end, texel + 1.0) - std::max(begin, double(texel))) / (end - begin);
    }

    double begin, end;
};

// Adds a row of an image, at `texels`, to the sums of a row of `small` texels.
void add_row(const TexelImage& image, const std::byte* texels, std::span<const Scale* const> scales,
             double weight, uint32_t small, std::vector<double>& sums) {
    const size_t bytes = byte_size(image.type);
    for (uint32_t x = 0; x < small; ++x) {
        const Stretch across(x, small, image.size.x);
        for (uint32_t i = across.first(); i < across.last(image.size.x); ++i) {
            const double fraction = weight * across.weight(i);
            for (uint32_t c = 0; c < image.channels; ++c) {
                sums[size_t{x} * image.channels + c] +=
                    fraction * double(scales[c]->read(texels + (size_t{i} * image.channels + c) * bytes));
            }
        }
    }
}

}  // namespace

TexelImage shrink(TexelImage image, uint32_t longest, TexelCodes codes) {
    const uint32_t side = std::max(image.size.x, image.size.y);
    if (side <= longest) return image;
    const auto in_proportion = [&](uint32_t n) {
        return std::max(1u, uint32_t(std::lround(double(n) * longest / side)));
    };
    TexelImage result{.size = {in_proportion(image.size.x), in_proportion(image.size.y)},
                      .channels = image.channels,
                      .type = image.type,
                      .texels = {},
                      .gamma = image.gamma};
    const size_t bytes = byte_size(image.type);
    const size_t row_in = size_t{image.size.x} * image.channels * bytes;
    const size_t row_out = size_t{result.size.x} * image.channels;
    result.texels.resize(row_out * result.size.y * bytes);
    const Scale color(image.type, image.gamma, codes == TexelCodes::encoded);
    const Scale alpha(image.type, {}, false);
    std::vector<const Scale*> scales(image.channels, &color);
    if (image.channels % 2 == 0) scales.back() = &alpha;
    std::byte* out = result.texels.data();
    for (uint32_t y = 0; y < result.size.y; ++y) {
        std::vector<double> sums(row_out);
        const Stretch down(y, result.size.y, image.size.y);
        for (uint32_t i = down.first(); i < down.last(image.size.y); ++i)
            add_row(image, image.texels.data() + i * row_in, scales, down.weight(i), result.size.x, sums);
        for (size_t i = 0; i < row_out; ++i, out += bytes)
            scales[i % image.channels]->write(out, sums[i]);
    }
    return result;
}

}  // namespace candela
