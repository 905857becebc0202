// See background.h. Rows are scaled first, then columns.
#include "image/background.h"

#include <algorithm>
#include <cmath>

#include "base/color.h"

namespace candela {
namespace {

// The texels along one axis that make one pixel.
struct Taps {
    uint32_t first = 0;
    std::vector<float> weights;  // Their sum is 1.
};

// For pixels from `begin` to `end` along an axis of `pixels` that shows the middle of `texels`, each of which
// is `scale` pixels long.
std::vector<Taps> make_taps(uint32_t begin, uint32_t end, uint32_t pixels, uint32_t texels, double scale) {
    const double offset = 0.5 * (texels - pixels / scale);
    const double radius = std::max(1.0, 1.0 / scale);
    std::vector<Taps> all;
    for (uint32_t pixel = begin; pixel < end; ++pixel) {
        const double middle = offset + (pixel + 0.5) / scale;
        const double last = texels - 1.0;
        const auto at = [&](double texel) { return uint32_t(std::clamp(texel, 0.0, last)); };
        Taps taps{.first = at(std::ceil(middle - radius - 0.5)), .weights = {}};
        double sum = 0.0;
        for (uint32_t i = taps.first; i <= at(std::floor(middle + radius - 0.5)); ++i) {
            const double weight = std::max(0.0, 1.0 - std::abs(i + 0.5 - middle) / radius);
            taps.weights.push_back(float(weight));
            sum += weight;
        }
        for (float& weight : taps.weights)
            weight = float(weight / sum);
        all.push_back(std::move(taps));
    }
    return all;
}

vec3 light_of(const TexelImage& image, size_t i) {
    const vec4 codes = texel_codes(image, i);
    vec3 light(codes);
    if (image.type != TexelType::half) {
        for (int c = 0; c < 3; ++c)
            light[c] = image.gamma ? std::pow(light[c], float(1.0 / *image.gamma)) : srgb_decode(light[c]);
    }
    return codes.w * light;
}

}  // namespace

std::vector<vec3> background_light(const TexelImage& image, uvec2 full, const PixelRect& rect, Tonemap curve,
                                   float scale) {
    const double larger =
        std::max(double(full.x) / image.size.x, double(full.y) / image.size.y);  // Pixels per texel.
    const std::vector<Taps> across = make_taps(rect.x0, rect.x1, full.x, image.size.x, larger);
    const std::vector<Taps> down = make_taps(rect.y0, rect.y1, full.y, image.size.y, larger);
    const uint32_t first = down.front().first;
    const uint32_t end = down.back().first + uint32_t(down.back().weights.size());
    const size_t width = across.size();

    std::vector<vec3> rows;  // Of texels; scaled across.
    std::vector<vec3> row(image.size.x);
    for (uint32_t y = first; y < end; ++y) {
        for (uint32_t x = 0; x < image.size.x; ++x)
            row[x] = light_of(image, size_t{y} * image.size.x + x);
        for (const Taps& taps : across) {
            vec3 sum(0.0f);
            for (size_t i = 0; i < taps.weights.size(); ++i)
                sum += taps.weights[i] * row[taps.first + i];
            rows.push_back(sum);
        }
    }
    std::vector<vec3> light;
    light.reserve(width * down.size());
    for (const Taps& taps : down) {
        for (size_t x = 0; x < width; ++x) {
            vec3 sum(0.0f);
            for (size_t i = 0; i < taps.weights.size(); ++i)
                sum += taps.weights[i] * rows[(taps.first - first + i) * width + x];
            light.push_back(image.type == TexelType::half ? tonemap(curve, scale * sum)
                                                          : glm::min(sum, vec3(1.0f)));
        }
    }
    return light;
}

}  // namespace candela
