// See irradiance.h.
#include "denoise/irradiance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shared/denoise.h"

namespace candela {
namespace {

// Irradiance is the colour over at least this albedo: light that does not come from the albedo, such as what
// a black surface mirrors, would be blown up without end.
constexpr float LEAST_ALBEDO = 0.05f;
// Values above this, in the unit of the picture, count as missing, and their squares would soon overflow.
constexpr float GREATEST_VALUE = 0x1p40f;
constexpr float GREATEST_VARIANCE = 0x1p80f;
// The pixels of which the unit is the median.
constexpr size_t MEDIAN_PIXELS = 1 << 16;
// Taken for the samples of a pixel, if nothing says how many it has.
constexpr float USUAL_SAMPLES = 16.0f;

vec3 at(const RgbPlanes& planes, size_t i) {
    return {planes[0][i], planes[1][i], planes[2][i]};
}

vec3 at(const std::optional<RgbPlanes>& planes, size_t i) {
    const vec3 value = planes ? at(*planes, i) : vec3(0.0f);
    return is_finite(value) ? value : vec3(0.0f);
}

float unit_of(const RgbPlanes& rgb) {
    const size_t pixels = rgb[0].size(), stride = pixels / MEDIAN_PIXELS + 1;
    std::vector<float> levels;
    for (size_t i = 0; i < pixels; i += stride) {
        const vec3 value = at(rgb, i);
        const float level = std::max({value.x, value.y, value.z});
        if (is_finite(value) && level >= FLOAT_MIN) levels.push_back(level);
    }
    if (levels.empty()) return 1.0f;
    const auto middle = levels.begin() + std::ptrdiff_t(levels.size() / 2);
    std::ranges::nth_element(levels, middle);
    // So that neither it nor its inverse leaves the normal floats.
    return std::exp2(std::clamp(std::round(std::log2(*middle)), -60.0f, 60.0f));
}

}  // namespace

Irradiance::Irradiance(const NoisyPicture& picture) : picture_(&picture), unit_(unit_of(picture.rgb)) {}

vec3 Irradiance::colour(size_t i) const {
    return at(picture_->rgb, i) / unit_;
}

vec3 Irradiance::reflected(size_t i) const {
    if (!picture_->albedo) return vec3(1.0f);
    return glm::clamp(at(picture_->albedo, i), vec3(LEAST_ALBEDO), vec3(1.0f));
}

bool Irradiance::has_value(size_t i) const {
    const vec3 value = colour(i);
    return is_finite(value) && glm::all(glm::lessThanEqual(glm::abs(value), vec3(GREATEST_VALUE)));
}

vec4 Irradiance::texel(uint32_t layer, size_t i) const {
    switch (layer) {
        case DENOISE_LAYER_NORMAL: {
            // The variance of the coordinates of a unit vector is 1 minus its squared mean.
            vec3 normal = at(picture_->normal, i);
            const float length = glm::length(normal);
            if (length == 0.0f) return vec4(0.0f);
            if (length > 1.0f) normal /= length;
            const float samples = picture_->samples.empty() ? USUAL_SAMPLES : picture_->samples[i];
            const float spread = std::max(0.0f, 1.0f - glm::dot(normal, normal));
            return {normal, spread / (samples >= 1.0f ? samples : 1.0f)};
        }
        case DENOISE_LAYER_ALBEDO:
            return {glm::clamp(at(picture_->albedo, i), 0.0f, 1.0f), 0.0f};
        case DENOISE_LAYER_SAMPLED: {
            if (!has_value(i)) return {vec3(DENOISE_MISSING), 0.0f};
            if (!picture_->variance) return {vec3(DENOISE_UNKNOWN), 0.0f};
            const vec3 variance = at(*picture_->variance, i) / unit_ / unit_;
            const bool is_known = glm::all(glm::greaterThanEqual(variance, vec3(0.0f))) &&
                                  glm::all(glm::lessThanEqual(variance, vec3(GREATEST_VARIANCE)));
            const vec3 albedo = reflected(i);
            return {is_known ? variance / albedo / albedo : vec3(DENOISE_UNKNOWN), 0.0f};
        }
        default: {
            const float alpha =
                picture_->alpha.empty() || !std::isfinite(picture_->alpha[i]) ? 0.0f : picture_->alpha[i];
            return {has_value(i) ? colour(i) / reflected(i) : vec3(0.0f), alpha};
        }
    }
}

void Irradiance::put(size_t i, vec4 filtered, bool is_there, Denoised& result) const {
    const vec3 value = is_there ? vec3(filtered) * reflected(i) * unit_ : at(picture_->rgb, i);
    for (size_t c = 0; c < 3; ++c)
        result.rgb[c][i] = value[int(c)];
    if (!result.alpha.empty()) result.alpha[i] = is_there ? filtered.w : picture_->alpha[i];
}

}  // namespace candela
