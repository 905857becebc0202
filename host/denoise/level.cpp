// See level.h.
#include "denoise/level.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace candela {
namespace {

// Of at most so many pixels, evenly spaced, the median is found.
constexpr size_t MEDIAN_PIXELS = 1 << 16;

}  // namespace

PictureLevel::PictureLevel(const RgbPlanes& rgb) {
    const size_t pixels = rgb[0].size(), stride = pixels / MEDIAN_PIXELS + 1;
    std::vector<float> levels;
    for (size_t i = 0; i < pixels; i += stride) {
        const vec3 value = rgb_at(rgb, i);
        const float level = std::max({value.x, value.y, value.z});
        if (is_finite(value) && level >= FLOAT_MIN) levels.push_back(level);
    }
    if (levels.empty()) return;
    const auto middle = levels.begin() + std::ptrdiff_t(levels.size() / 2);
    std::ranges::nth_element(levels, middle);
    // So that neither its square nor the inverse of that leaves the normal floats.
    unit_ = std::exp2(std::clamp(std::round(std::log2(*middle)), -60.0f, 60.0f));
}

}  // namespace candela
