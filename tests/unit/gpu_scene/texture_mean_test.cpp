// The mean of a texture over a piece of a surface, against its values at many places of the piece.
#include "gpu_scene/texture_mean.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "probe/random.h"

namespace candela {
namespace {

// Grey, row-major from the top.
TexelImage grey(uvec2 size, const std::vector<uint8_t>& codes) {
    TexelImage image{.size = size, .channels = 1, .type = TexelType::unorm8, .texels = {}, .gamma = {}};
    for (const uint8_t code : codes)
        image.texels.push_back(std::byte(code));
    return image;
}

TexelImage random_image(uvec2 size, uint32_t seed) {
    Random random(seed);
    std::vector<uint8_t> codes(size_t(size.x) * size.y);
    for (uint8_t& code : codes)
        code = uint8_t(random.bits());
    return grey(size, codes);
}

float mean_of(const TexelImage& image, const Texture& texture, const std::vector<vec2>& corners) {
    return ImagePyramid(image, TextureEncoding::linear).mean(texture, corners).x;
}

// The texture, which repeats, at (u, v).
double value_at(const TexelImage& image, const Texture& texture, vec2 uv) {
    const auto texel = [&](double x, double y) {
        const double w = image.size.x, h = image.size.y;
        const size_t column = size_t(x - w * std::floor(x / w)), row = size_t(y - h * std::floor(y / h));
        return double(std::to_integer<uint8_t>(image.texels[row * image.size.x + column])) / 255.0;
    };
    double x = double(uv.x) * image.size.x, y = (1.0 - double(uv.y)) * image.size.y;
    if (texture.filter == TextureFilter::nearest) return texel(std::floor(x), std::floor(y));
    x -= 0.5;
    y -= 0.5;
    const double i = std::floor(x), j = std::floor(y), a = x - i, b = y - j;
    return (1 - a) * (1 - b) * texel(i, j) + a * (1 - b) * texel(i + 1, j) + (1 - a) * b * texel(i, j + 1) +
           a * b * texel(i + 1, j + 1);
}

// Triangles up to 12 texels wide, against a grid of places. The texture changes by at most 2 from a texel to
// the next, so that in one of n^2 cells it is off by 2 * 12 / n of its middle at most; errors of cells
// cancel, all but those of texels' edges where the filter is `nearest`: about 12 * n cells of n^2, in random
// directions.
TEST(TextureMean, IsThatOfTheTexelsThatATriangleCovers) {
    const TexelImage image = random_image({64, 48}, 1);
    Random random(2);
    constexpr int N = 300;
    for (int k = 0; k < 40; ++k) {
        const Texture texture{.filter = k % 2 == 0 ? TextureFilter::bilinear : TextureFilter::nearest};
        const vec2 origin = 3.0f * random.square() - 1.5f;
        const auto corner = [&] { return origin + 12.0f * random.square() / vec2(64.0f, 48.0f); };
        const std::vector<vec2> corners{corner(), corner(), corner()};
        double sum = 0.0;
        for (int i = 0; i < N * N; ++i) {
            vec2 b = (vec2(i % N, i / N) + 0.5f) / float(N);
            if (b.x + b.y > 1.0f) b = 1.0f - b;
            sum += value_at(image, texture,
                            corners[0] + b.x * (corners[1] - corners[0]) + b.y * (corners[2] - corners[0]));
        }
        EXPECT_NEAR(mean_of(image, texture, corners), sum / (N * N), 0.003) << k;
    }
}

TEST(TextureMean, OfAWholeImageIsThatOfAllTexels) {
    const TexelImage image = random_image({256, 128}, 3);
    double sum = 0.0;
    for (const std::byte code : image.texels)
        sum += std::to_integer<int>(code) / 255.0;
    const double mean = sum / double(image.texels.size());
    // Sums of 24-bit floats over eight levels.
    EXPECT_NEAR(mean_of(image, {}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}), mean, 1e-5);
    EXPECT_NEAR(mean_of(image, {}, {{0, 0}, {1000, 0}, {0, 1000}}), mean, 1e-5);
}

TEST(TextureMean, OfAPointOrALineIsThatOfTheTexelsThere) {
    const TexelImage palette = random_image({8, 4}, 4);
    for (uint32_t i = 0; i < 32; ++i) {
        const vec2 uv((float(i % 8) + 0.5f) / 8.0f, 1.0f - (float(i / 8) + 0.5f) / 4.0f);
        EXPECT_NEAR(mean_of(palette, {}, {uv, uv, uv}), std::to_integer<int>(palette.texels[i]) / 255.0,
                    1e-6);
    }
    const auto code = [&](size_t i) { return std::to_integer<int>(palette.texels[i]) / 255.0; };
    const vec2 first(0.5f / 8.0f, 1.0f - 0.5f / 4.0f), second(1.5f / 8.0f, 1.0f - 0.5f / 4.0f);
    EXPECT_NEAR(mean_of(palette, {}, {first, second, second}), 0.5 * (code(0) + code(1)), 0.05);
}

// One texel of a large image shines. Whatever shape sees it is not black, and what does not is.
TEST(TextureMean, IsPositiveWhereATexelIsNotBlack) {
    const uvec2 size(512, 512);
    std::vector<uint8_t> codes(size_t(size.x) * size.y);
    codes[300 * size.x + 200] = 1;
    const TexelImage image = grey(size, codes);
    Random random(5);
    const vec2 texel((200.5f) / 512.0f, 1.0f - 300.5f / 512.0f);
    for (int k = 0; k < 200; ++k) {
        const float width = std::pow(2.0f, -9.0f + 11.0f * random.unit());
        const vec2 a = width * (random.square() - 0.5f), b = width * (random.square() - 0.5f);
        EXPECT_GT(mean_of(image, {}, {texel + a, texel + b, texel - 0.5f * (a + b)}), 0.0f) << k;
        const vec2 away = texel + vec2(0.3f, 0.2f);
        if (width < 0.1f) {
            EXPECT_EQ(mean_of(image, {}, {away + a, away + b, away - 0.5f * (a + b)}), 0.0f) << k;
        }
    }
    EXPECT_GT(mean_of(image, {}, {texel, texel + vec2(1e30f, 0), texel}), 0.0f);
}

}  // namespace
}  // namespace candela
