// See texture_mean.h.
#include "gpu_scene/texture_mean.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/color.h"

namespace candela {
namespace {

// Texel i along an axis of n, for any i.
uint32_t wrapped(double i, uint32_t n, Wrap wrap) {
    if (wrap == Wrap::clamp) return uint32_t(std::clamp(i, 0.0, n - 1.0));
    const double period = wrap == Wrap::repeat ? n : 2.0 * n;
    const auto within = uint32_t(std::min(i - period * std::floor(i / period), period - 1.0));
    return within < n ? within : 2 * n - 1 - within;
}

}  // namespace

vec3 texel_color(const TexelImage& image, TextureEncoding encoding, size_t i) {
    const vec4 codes = texel_codes(image, i);
    const vec3 color(codes.x, codes.y, codes.z);
    if (encoding != TextureEncoding::srgb || image.type == TexelType::half) return color;
    return {srgb_decode(color.x), srgb_decode(color.y), srgb_decode(color.z)};
}

ImagePyramid::ImagePyramid(const TexelImage& image, TextureEncoding encoding) {
    Level base{image.size, std::vector<vec3>(size_t(image.size.x) * image.size.y)};
    for (size_t i = 0; i < base.texels.size(); ++i)
        base.texels[i] = texel_color(image, encoding, i);
    levels_.push_back(std::move(base));
    while (levels_.back().texels.size() > 1) {
        const Level& fine = levels_.back();
        Level half{(fine.size + 1u) / 2u, {}};
        for (uint32_t y = 0; y < half.size.y; ++y) {
            for (uint32_t x = 0; x < half.size.x; ++x) {
                vec3 sum(0.0f);
                for (const uvec2 corner : {uvec2(0, 0), uvec2(1, 0), uvec2(0, 1), uvec2(1, 1)}) {
                    const uvec2 at = min(2u * uvec2(x, y) + corner, fine.size - 1u);
                    sum += fine.texels[size_t(at.y) * fine.size.x + at.x];
                }
                half.texels.push_back(0.25f * sum);
            }
        }
        levels_.push_back(std::move(half));
    }
}

// If the texture mixes a texel that is not black into some place of the piece, that texel is at most a texel
// of the image and one gap away from one of `places`. On a level whose texels are at least four times as
// large as both, it lies in one of the four texels that are mixed there.
vec3 ImagePyramid::mean(const Texture& texture, std::span<const vec2> places, float spacing) const {
    constexpr float SAFETY = 4.0f;
    const float stretch = std::max(length(texture.rows[0]), length(texture.rows[1]));
    const float gap =
        SAFETY * std::max(1.0f, stretch * spacing * float(std::max(levels_[0].size.x, levels_[0].size.y)));
    const auto level = std::min(size_t(std::ceil(std::log2(gap))), levels_.size() - 1);
    vec3 sum(0.0f);
    for (const vec2 place : places)
        sum += look_up(level, texture, place);
    return sum / float(places.size());
}

vec3 ImagePyramid::look_up(size_t number, const Texture& texture, vec2 place) const {
    const Level& level = levels_[number];
    // The size of the image in texels of the level: the last ones may reach beyond the image, since sizes are
    // rounded up.
    const glm::dvec2 size = glm::dvec2(levels_[0].size) / std::exp2(double(number));
    const dvec3 uv1(place.x, place.y, 1.0);
    const double x = dot(dvec3(texture.rows[0]), uv1) * size.x - 0.5;
    const double y = (1.0 - dot(dvec3(texture.rows[1]), uv1)) * size.y - 0.5;
    const auto texel = [&](double column, double row) {
        return level.texels[size_t(wrapped(row, level.size.y, texture.wrap_v)) * level.size.x +
                            wrapped(column, level.size.x, texture.wrap_u)];
    };
    const double i = std::floor(x), j = std::floor(y);
    const vec3 upper = mix(texel(i, j), texel(i + 1, j), float(x - i));
    return mix(upper, mix(texel(i, j + 1), texel(i + 1, j + 1), float(x - i)), float(y - j));
}

}  // namespace candela
