// See irradiance.h.
#include "denoise/irradiance.h"

#include <algorithm>
#include <cmath>

#include "denoise/smooth_albedo.h"
#include "shared/denoise.h"

namespace candela {
namespace {

// Irradiance is the colour over at least this albedo: light that does not come from the albedo, such as what
// a black surface mirrors, would be blown up without end.
constexpr float LEAST_ALBEDO = 0.05f;
// Of irradiance, in the unit of the picture: where more is given, nothing is known.
constexpr float GREATEST_VARIANCE = 0x1p80f;
// Taken for the samples of a pixel, if nothing says how many it has.
constexpr float USUAL_SAMPLES = 16.0f;

vec3 finite(vec3 value) {
    return is_finite(value) ? value : vec3(0.0f);
}

}  // namespace

Irradiance::Irradiance(const NoisyPicture& picture) : picture_(&picture), level_(picture.rgb) {}

void Irradiance::load(const PixelRect& rect) {
    rect_ = rect;
    if (picture_->albedo) albedo_ = smooth_albedo(*picture_, rect);
}

vec3 Irradiance::albedo(size_t i) const {
    if (albedo_.empty()) return vec3(0.0f);
    const size_t x = i % picture_->size.x - rect_.x0, y = i / picture_->size.x - rect_.y0;
    return albedo_[y * rect_.width() + x];
}

vec3 Irradiance::colour(size_t i) const {
    return rgb_at(picture_->rgb, i) / level_.unit();
}

vec3 Irradiance::reflected(size_t i) const {
    if (!picture_->albedo) return vec3(1.0f);
    const vec3 own = albedo(i);
    return glm::clamp(is_finite(own) ? own : albedo_around(i), vec3(LEAST_ALBEDO), vec3(1.0f));
}

vec3 Irradiance::albedo_around(size_t i) const {
    const uint32_t x = uint32_t(i % picture_->size.x), y = uint32_t(i / picture_->size.x);
    vec3 sum(0.0f);
    float count = 0.0f;
    for (uint32_t v = y - std::min(y, 1u); v < std::min(y + 2, picture_->size.y); ++v) {
        for (uint32_t u = x - std::min(x, 1u); u < std::min(x + 2, picture_->size.x); ++u) {
            const vec3 albedo = rgb_at(*picture_->albedo, size_t(v) * picture_->size.x + u);
            if (!is_finite(albedo)) continue;
            sum += albedo;
            count += 1.0f;
        }
    }
    return count > 0.0f ? sum / count : vec3(1.0f);
}

bool Irradiance::has_value(size_t i) const {
    return level_.holds(rgb_at(picture_->rgb, i));
}

bool Irradiance::has_features(size_t i) const {
    return (!picture_->albedo || is_finite(rgb_at(*picture_->albedo, i))) &&
           (!picture_->normal || is_finite(rgb_at(*picture_->normal, i)));
}

vec4 Irradiance::texel(uint32_t layer, size_t i) const {
    switch (layer) {
        case DENOISE_LAYER_NORMAL: {
            // The variance of the coordinates of a unit vector is 1 minus its squared mean.
            vec3 normal = picture_->normal ? finite(rgb_at(*picture_->normal, i)) : vec3(0.0f);
            if (!has_features(i)) return vec4(vec3(0.0f), -1.0f);
            const float length = glm::length(normal);
            if (length == 0.0f) return vec4(0.0f);
            if (length > 1.0f) normal /= length;
            const float samples = picture_->samples.empty() ? USUAL_SAMPLES : picture_->samples[i];
            const float spread = std::max(0.0f, 1.0f - glm::dot(normal, normal));
            return {normal, spread / (samples >= 1.0f ? samples : 1.0f)};
        }
        case DENOISE_LAYER_ALBEDO:
            return {glm::clamp(finite(albedo(i)), 0.0f, 1.0f), 0.0f};
        case DENOISE_LAYER_SAMPLED: {
            if (!has_value(i)) return {vec3(DENOISE_MISSING), 0.0f};
            if (!picture_->variance) return {vec3(DENOISE_UNKNOWN), 0.0f};
            const vec3 variance = rgb_at(*picture_->variance, i) / level_.unit() / level_.unit();
            const bool is_known = glm::all(glm::greaterThanEqual(variance, vec3(0.0f))) &&
                                  glm::all(glm::lessThanEqual(variance, vec3(GREATEST_VARIANCE)));
            const vec3 over = reflected(i);
            return {is_known ? variance / over / over : vec3(DENOISE_UNKNOWN), 0.0f};
        }
        default: {
            const float alpha =
                picture_->alpha.empty() || !std::isfinite(picture_->alpha[i]) ? 0.0f : picture_->alpha[i];
            return {has_value(i) ? colour(i) / reflected(i) : vec3(0.0f), alpha};
        }
    }
}

void Irradiance::put(size_t i, vec4 filtered, bool is_there, Denoised& result) const {
    const vec3 value = is_there ? vec3(filtered) * reflected(i) * level_.unit() : rgb_at(picture_->rgb, i);
    for (size_t c = 0; c < 3; ++c)
        result.rgb[c][i] = value[int(c)];
    if (!result.alpha.empty()) result.alpha[i] = is_there ? filtered.w : picture_->alpha[i];
}

}  // namespace candela
