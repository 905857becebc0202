// See blend.h.
#include "denoise/blend.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "base/parallel.h"
#include "denoise/level.h"

namespace candela {
namespace {

// Weights of the pixels of a window along one axis.
constexpr std::array<double, 5> WINDOW{1.0, 2.0, 3.0, 2.0, 1.0};
constexpr uint32_t RADIUS = uint32_t(WINDOW.size()) / 2;
// The share of the variance that is taken for noise: samples of a low-discrepancy sequence differ more than
// their mean errs. Taking all of it for noise would hide a bias.
constexpr double NOISE_SHARE = 0.85;
// The level below which errors count as if absolute, of the picture's.
constexpr double DARKNESS = 1e-3;
// Rows that one step weighs, of those for which it computes moments.
constexpr uint32_t STRIP_ROWS = 32;

// The relative squared difference of a pixel and the part of it that noise explains; zeros if it is not to
// count.
struct Moments {
    double difference = 0.0, noise = 0.0;

    void add(double weight, const Moments& other) {
        difference += weight * other.difference;
        noise += weight * other.noise;
    }
};

template <class Planes>
bool is_finite_at(const Planes& planes, size_t i) {
    return std::isfinite(planes[0][i]) && std::isfinite(planes[1][i]) && std::isfinite(planes[2][i]);
}

class Weights {
  public:
    Weights(uvec2 size, const RgbPlanes& noisy, const RgbPlanes& variance, const Denoised& denoised)
        : size_(size),
          noisy_(noisy),
          variance_(variance),
          denoised_(denoised),
          level_(noisy),
          darkness_(std::pow(DARKNESS * double(level_.unit()), 2.0)) {}

    // Fills the rows from y0 to y1, exclusive.
    void fill(uint32_t y0, uint32_t y1, std::vector<float>& weights) const {
        const uint32_t first = y0 - std::min(y0, RADIUS), last = std::min(y1 + RADIUS, size_.y);
        std::vector<Moments> moments;
        moments.reserve(size_t(last - first) * size_.x);
        for (size_t i = size_t(first) * size_.x; i < size_t(last) * size_.x; ++i)
            moments.push_back(moments_of(i));
        std::vector<Moments> columns(size_.x);
        for (uint32_t y = y0; y < y1; ++y) {
            std::ranges::fill(columns, Moments{});
            for (uint32_t row = std::max(y, first + RADIUS) - RADIUS; row < std::min(y + RADIUS + 1, last);
                 ++row) {
                const double weight = WINDOW[row + RADIUS - y];
                for (uint32_t x = 0; x < size_.x; ++x)
                    columns[x].add(weight, moments[size_t(row - first) * size_.x + x]);
            }
            for (uint32_t x = 0; x < size_.x; ++x) {
                Moments sum;
                for (uint32_t at = std::max(x, RADIUS) - RADIUS; at < std::min(x + RADIUS + 1, size_.x); ++at)
                    sum.add(WINDOW[at + RADIUS - x], columns[at]);
                const size_t i = size_t(y) * size_.x + x;
                weights[i] = weight(i, sum);
            }
        }
    }

  private:
    Moments moments_of(size_t i) const {
        if (!level_.holds(rgb_at(noisy_, i)) || !is_finite_at(variance_, i) ||
            !is_finite_at(denoised_.rgb, i))
            return {};
        const double others = denoised_.own_weight.empty() ? 1.0 : 1.0 - double(denoised_.own_weight[i]);
        Moments moments;
        for (size_t c = 0; c < 3; ++c) {
            const double value = denoised_.rgb[c][i], variance = variance_[c][i];
            const double difference = value - noisy_[c][i], level = value * value + variance + darkness_;
            if (level <= 0.0) continue;
            moments.difference += difference * difference / level;
            moments.noise += others * variance / level;
        }
        return moments;
    }

    float weight(size_t i, const Moments& sum) const {
        if (!is_finite_at(denoised_.rgb, i)) return 1.0f;
        if (!level_.holds(rgb_at(noisy_, i)) || !is_finite_at(variance_, i)) return 0.0f;
        if (sum.noise <= 0.0) return 1.0f;
        return float(std::max(0.0, 1.0 - NOISE_SHARE * sum.noise / sum.difference));
    }

    uvec2 size_;
    const RgbPlanes& noisy_;
    const RgbPlanes& variance_;
    const Denoised& denoised_;
    PictureLevel level_;
    double darkness_;
};

}  // namespace

std::vector<float> noisy_weights(uvec2 size, const RgbPlanes& noisy, const RgbPlanes& variance,
                                 const Denoised& denoised) {
    std::vector<float> weights(size_t(size.x) * size.y);
    assert(denoised.rgb[0].size() == weights.size());
    const Weights rows(size, noisy, variance, denoised);
    parallel_for((size.y + STRIP_ROWS - 1) / STRIP_ROWS, [&](size_t strip) {
        const uint32_t y0 = uint32_t(strip) * STRIP_ROWS;
        rows.fill(y0, std::min(y0 + STRIP_ROWS, size.y), weights);
    });
    return weights;
}

void blend(const std::vector<float>& noisy_weights, const RgbPlanes& noisy, std::span<const float> alpha,
           Denoised& denoised) {
    const auto blend_plane = [&](std::span<const float> from, std::vector<float>& to) {
        for (size_t i = 0; i < to.size(); ++i) {
            const float weight = noisy_weights[i];
            if (weight >= 1.0f) {
                to[i] = from[i];
            } else if (weight > 0.0f) {
                to[i] += weight * (from[i] - to[i]);
            }
        }
    };
    for (size_t c = 0; c < 3; ++c)
        blend_plane(noisy[c], denoised.rgb[c]);
    if (!denoised.alpha.empty()) blend_plane(alpha, denoised.alpha);
}

void blend_with(const NoisyPicture& noisy, Denoised& denoised) {
    if (!noisy.variance) return;
    blend(noisy_weights(noisy.size, noisy.rgb, *noisy.variance, denoised), noisy.rgb, noisy.alpha, denoised);
}

}  // namespace candela
