// See pace.h.
#include "view/pace.h"

#include <algorithm>
#include <cmath>

namespace candela {

uvec2 scaled_size(uvec2 size, uint32_t scale) {
    return max(size / scale, uvec2(1));
}

uint32_t next_scale(uint32_t scale, double seconds) {
    constexpr double CLEARLY = 0.8;  // So that the scale does not go to and fro.
    if (seconds > MOVING_SECONDS) return std::min(2 * scale, COARSEST_SCALE);
    return 4.0 * seconds < CLEARLY * MOVING_SECONDS ? std::max(scale / 2, 1u) : scale;
}

std::optional<double> relative_error(const Accumulation& state) {
    constexpr double DARK = 0.01;  // Keeps black pixels from counting for much.
    const Image image = make_image(state, {.variance = true}, {});
    const RgbPlanes means = *image.find_rgb();
    const RgbPlanes variances = *image.find_rgb("Variance");
    const auto each_value = [&](const auto& use) {
        for (size_t c = 0; c < 3; ++c) {
            for (size_t i = 0; i < image.pixel_count(); ++i) {
                if (state.sample_count(i) >= 2) use(double(means[c][i]), double(variances[c][i]));
            }
        }
    };
    double mean = 0.0;
    double count = 0.0;
    each_value([&](double x, double) {
        mean += x;
        count += 1.0;
    });
    if (mean <= 0.0) return std::nullopt;
    mean /= count;
    double sum = 0.0;
    each_value([&](double x, double variance) { sum += variance / (x * x + DARK * mean * mean); });
    return std::sqrt(sum / count);
}

}  // namespace candela
