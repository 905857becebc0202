// See develop.h.
#include "image/develop.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/color.h"
#include "base/error.h"
#include "image/srgb_codes.h"

namespace candela {
namespace {

RgbPlanes colours_of(const Image& image) {
    const std::optional<RgbPlanes> rgb = image.find_rgb();
    if (!rgb) throw Error("cannot develop the image: it lacks a channel R, G or B; render them");
    return *rgb;
}

const Channel& alpha_of(const Image& image) {
    const Channel* const alpha = image.find("A");
    if (alpha == nullptr)
        throw Error("cannot put the image before a background: it lacks the channel A; render it");
    return *alpha;
}

// The share of camera rays that hit something; null if it is unknown, and all may.
const Channel* coverage_of(const Image& image) {
    const Channel* const first_hit = image.find(FIRST_HIT_ALPHA);
    return first_hit != nullptr ? first_hit : image.find("A");
}

vec3 colour_at(const RgbPlanes& rgb, size_t i) {
    return {rgb[0][i], rgb[1][i], rgb[2][i]};
}

// Writes the pixels of a picture, one channel after the other.
class Writer {
  public:
    Writer(TexelImage& image) : image_(image), at_(image.texels.data()) {}

    // Appends a code of a number from 0 to 1.
    void number(float value) {
        if (image_.type == TexelType::unorm8) {
            *at_++ = std::byte(std::lround(value * 255.0f));
            return;
        }
        const auto code = uint16_t(std::lround(value * 65535.0f));
        std::memcpy(at_, &code, sizeof code);
        at_ += sizeof code;
    }
    // Appends the light of the display, each from 0 to 1, as sRGB.
    void light(vec3 light) {
        for (int c = 0; c < 3; ++c) {
            if (image_.type == TexelType::unorm8) {
                *at_++ = std::byte(codes_(light[c]));
            } else {
                number(std::min(srgb_encode(light[c]), 1.0f));
            }
        }
    }

  private:
    TexelImage& image_;
    std::byte* at_;
    const SrgbCodes& codes_ = SrgbCodes::table();
};

// What a pixel shows of its scene.
struct Layer {
    vec3 light;   // D.
    float alpha;  // A, in [0, 1].
};

// `exposure`: the factor of light.
Layer layer_at(vec3 colour, float alpha, float coverage, Tonemap curve, float exposure) {
    const float share = std::clamp(coverage, 0.0f, 1.0f);
    if (!(share > 0.0f)) return {vec3(0.0f), std::clamp(alpha, 0.0f, 1.0f)};
    return {share * tonemap(curve, exposure / share * colour), std::clamp(alpha, 0.0f, 1.0f)};
}

void write_transparent(Writer& writer, const Layer& layer) {
    const vec3& light = layer.light;
    const float alpha = std::max({layer.alpha, light.x, light.y, light.z});
    writer.light(alpha > 0.0f ? glm::min(light / alpha, vec3(1.0f)) : vec3(0.0f));
    writer.number(alpha);
}

void develop_before(const Image& image, const Development& development, Writer& writer) {
    const Background& background = *development.background;
    const RgbPlanes rgb = colours_of(image);
    const std::vector<float>& alphas = alpha_of(image).values;
    const std::vector<float>& coverages = coverage_of(image)->values;
    const float exposure = std::exp2(development.exposure_ev);
    std::vector<vec3> behind;
    if (const auto* picture = std::get_if<TexelImage>(&background))
        behind = background_light(*picture, image.full, image.data, development.curve, exposure);
    const auto* const colour = std::get_if<vec3>(&background);
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const Layer layer = layer_at(colour_at(rgb, i), alphas[i], coverages[i], development.curve, exposure);
        if (std::holds_alternative<Transparent>(background)) {
            write_transparent(writer, layer);
        } else {
            const vec3 light = colour != nullptr ? *colour : behind[i];
            writer.light(glm::min(layer.light + (1.0f - layer.alpha) * light, vec3(1.0f)));
        }
    }
}

}  // namespace

TexelImage develop(const Image& image, const Development& development) {
    assert(std::abs(development.exposure_ev) <= MAX_EXPOSURE_EV && development.type != TexelType::half);
    const Background* const background = development.background;
    const bool transparent = background != nullptr && std::holds_alternative<Transparent>(*background);
    TexelImage picture{.size = {image.data.width(), image.data.height()},
                       .channels = transparent ? 4u : 3u,
                       .type = development.type,
                       .texels = {},
                       .gamma = {}};
    picture.texels.resize(image.pixel_count() * picture.channels * byte_size(picture.type));
    Writer writer(picture);
    if (background != nullptr) {
        develop_before(image, development, writer);
        return picture;
    }
    const RgbPlanes rgb = colours_of(image);
    const float scale = std::exp2(development.exposure_ev);
    for (size_t i = 0; i < image.pixel_count(); ++i)
        writer.light(tonemap(development.curve, scale * colour_at(rgb, i)));
    return picture;
}

float auto_exposure(const Image& image) {
    const RgbPlanes rgb = colours_of(image);
    const Channel* const coverage = coverage_of(image);
    std::vector<std::pair<double, double>> lit;  // Luminance and weight.
    double total = 0.0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const double weight = coverage == nullptr ? 1.0 : double(coverage->values[i]);
        const double light = double(luminance(colour_at(rgb, i)));
        if (!(weight > 0.0 && light > 0.0 && std::isfinite(light))) continue;
        lit.emplace_back(light / weight, weight);
        total += weight;
    }
    std::ranges::sort(lit);
    double below = 0.0;
    for (const auto& [light, weight] : lit) {
        below += weight;
        if (below < AUTO_PERCENTILE / 100.0 * total) continue;
        return float(
            std::clamp(std::log2(AUTO_LUMINANCE / light), -double(MAX_EXPOSURE_EV), double(MAX_EXPOSURE_EV)));
    }
    return 0.0f;
}

}  // namespace candela
