// See blend.h.
#include "denoise/blend.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "denoise/level.h"
#include "denoise/opening.h"

namespace candela {
namespace {

// Weights of the pixels of a window along one axis.
constexpr std::array<double, 5> WINDOW{1.0, 2.0, 3.0, 2.0, 1.0};
constexpr uint32_t RADIUS = uint32_t(WINDOW.size()) / 2;
// How much is believed of a difference, by samples per pixel.
struct Belief {
    double samples;
    double neighbours_share;  // How far a variance below the mean of similar pixels is raised to it.
    // How much of the variance is taken for noise. Samples of a low-discrepancy sequence differ more than
    // their mean errs, and taking all of it for noise would hide a bias; few samples tell the variance badly,
    // and a denoised picture errs far less than they do.
    double noise_share;
    double single_share;    // The same, beside the difference of a single pixel.
    double agreement_gain;  // By how much the agreement of neighbours counts, see below.
};
constexpr std::array BELIEFS{Belief{16.0, 1.0, 1.2, 2.0, 1.0}, Belief{256.0, 1.0, 1.0, 1.0, 4.0},
                             Belief{4096.0, 0.0, 0.1, 0.1, 4.0}};
constexpr double UNKNOWN_SAMPLES = 64.0;  // Taken if nothing says how many there are.
// The level below which errors count as if absolute, of the picture's.
constexpr double DARKNESS = 1e-3;
// Differences of neighbours agree by a bias alone, whatever the noise: the share of the squared difference by
// which they do is that of the bias, and more, since edges turn. Of their products, so many standard
// deviations are taken for chance.
constexpr double CHANCE = 1.5;
// A bias is as long as an edge: what neighbours agree on counts along lines of 2 * 3 + 1 pixels, and what
// noise does not explain along 2 * 1 + 1.
constexpr uint32_t AGREEING_RADIUS = 3, UNEXPLAINED_RADIUS = 1;
// The noise of a pixel counts by itself as far as it is more than so many times that of the window.
constexpr double OUTLIER = 4.0;
// Pixels are similar if their denoised values differ by less than this share.
constexpr double SIMILAR = 0.2;
// The variance of a similar pixel counts up to this multiple of the squared denoised value: an outlier says
// little about the pixels around it.
constexpr double VARIANCE_LIMIT = 2.0;
// Rows that one step weighs, and those before and after on which their weights depend.
constexpr uint32_t STRIP_ROWS = 32, STRIP_MARGIN = 2 * AGREEING_RADIUS;

// The relative difference of a pixel, and the part of its square that noise explains; zeros if it is not to
// count.
struct Difference {
    dvec3 value{0.0};
    double noise = 0.0;
};

// Between those of BELIEFS, in proportion to the logarithm of the samples.
Belief belief_of(double samples_per_pixel) {
    const double samples = samples_per_pixel > 0.0 ? samples_per_pixel : UNKNOWN_SAMPLES;
    const auto after = std::ranges::find_if(BELIEFS, [&](const Belief& b) { return b.samples >= samples; });
    if (after == BELIEFS.begin()) return BELIEFS.front();
    if (after == BELIEFS.end()) return BELIEFS.back();
    const Belief &a = after[-1], &b = *after;
    const double t = std::log(samples / a.samples) / std::log(b.samples / a.samples);
    const auto between = [&](double Belief::*field) { return std::lerp(a.*field, b.*field, t); };
    return {samples, between(&Belief::neighbours_share), between(&Belief::noise_share),
            between(&Belief::single_share), between(&Belief::agreement_gain)};
}

// A weighted sum of products of differences, and the variance that it would have by chance.
struct Agreement {
    double sum = 0.0, variance = 0.0;

    void add(double w, const Agreement& other) {
        sum += w * other.sum;
        variance += w * w * other.variance;
    }

    double beyond_chance() const { return sum - CHANCE * std::sqrt(variance); }
};

// Sums over a window: of weights, of squared differences, of noise, and the agreement with the neighbours
// beside and below.
struct Moments {
    double weight = 1.0, square = 0.0, noise = 0.0;
    Agreement beside{}, below{};

    void add(double w, const Moments& other) {
        weight += w * other.weight;
        square += w * other.square;
        noise += w * other.noise;
        beside.add(w, other.beside);
        below.add(w, other.below);
    }
};

Agreement agreement(const dvec3& a, const dvec3& b) {
    const double product = dot(a, b);
    return {product, product * product};
}

template <class Planes>
bool is_finite_at(const Planes& planes, size_t i) {
    return std::isfinite(planes[0][i]) && std::isfinite(planes[1][i]) && std::isfinite(planes[2][i]);
}

class Weights {
  public:
    Weights(uvec2 size, const RgbPlanes& noisy, const RgbPlanes& variance, const Denoised& denoised,
            double samples_per_pixel)
        : size_(size),
          noisy_(noisy),
          variance_(variance),
          denoised_(denoised),
          level_(noisy),
          darkness_(std::pow(DARKNESS * double(level_.unit()), 2.0)),
          belief_(belief_of(samples_per_pixel)) {}

    // Fills the rows from y0 to y1, exclusive.
    void fill(uint32_t y0, uint32_t y1, std::vector<float>& weights) const {
        const uint32_t before = y0 - std::min(y0, STRIP_MARGIN), after = std::min(y1 + STRIP_MARGIN, size_.y);
        const std::vector<Moments> windows = windows_of_rows(before, after);
        const auto along_lines = [&](double (Weights::*share)(const Moments&) const, uint32_t radius) {
            std::vector<float> shares(windows.size());
            for (size_t i = 0; i < shares.size(); ++i)
                shares[i] = float(std::clamp((this->*share)(windows[i]), 0.0, 1.0));
            return opened_by_lines(shares, {size_.x, after - before}, radius);
        };
        const std::vector<float> unexplained = along_lines(&Weights::unexplained_of, UNEXPLAINED_RADIUS);
        const std::vector<float> agreeing = along_lines(&Weights::agreeing_of, AGREEING_RADIUS);
        for (size_t i = size_t(y0) * size_.x, at = size_t(y0 - before) * size_.x; i < size_t(y1) * size_.x;
             ++i, ++at)
            weights[i] = weight(i, windows[at], double(std::max(unexplained[at], agreeing[at])));
    }

  private:
    // The sums over the windows of the pixels of the rows from y0 to y1, exclusive.
    std::vector<Moments> windows_of_rows(uint32_t y0, uint32_t y1) const {
        const uint32_t first = y0 - std::min(y0, RADIUS), last = std::min(y1 + RADIUS, size_.y);
        const std::vector<Moments> moments = moments_of_rows(first, last);
        std::vector<Moments> columns(size_.x), windows;
        windows.reserve(size_t(y1 - y0) * size_.x);
        for (uint32_t y = y0; y < y1; ++y) {
            std::ranges::fill(columns, Moments{.weight = 0.0});
            for (uint32_t row = std::max(y, first + RADIUS) - RADIUS; row < std::min(y + RADIUS + 1, last);
                 ++row) {
                const double weight = WINDOW[row + RADIUS - y];
                for (uint32_t x = 0; x < size_.x; ++x)
                    columns[x].add(weight, moments[size_t(row - first) * size_.x + x]);
            }
            for (uint32_t x = 0; x < size_.x; ++x) {
                Moments sum{.weight = 0.0};
                for (uint32_t at = std::max(x, RADIUS) - RADIUS; at < std::min(x + RADIUS + 1, size_.x); ++at)
                    sum.add(WINDOW[at + RADIUS - x], columns[at]);
                windows.push_back(sum);
            }
        }
        return windows;
    }

    // Of the rows from `first` to `last`, exclusive. At the picture's edge, neighbours on the other side
    // count.
    std::vector<Moments> moments_of_rows(uint32_t first, uint32_t last) const {
        std::vector<Moments> moments(size_t(last - first) * size_.x);
        std::vector<Difference> above = neighbours(first, -1), row = differences(first), below;
        for (uint32_t y = first; y < last; ++y) {
            below = neighbours(y, 1);
            const std::vector<Difference>& other = y + 1 < size_.y ? below : above;
            for (uint32_t x = 0; x < size_.x; ++x) {
                const dvec3 value = row[x].value;
                const dvec3 beside = x + 1 < size_.x ? row[x + 1].value
                                     : x > 0         ? row[x - 1].value
                                                     : dvec3(0.0);
                moments[size_t(y - first) * size_.x + x] = {1.0, dot(value, value), row[x].noise,
                                                            agreement(value, beside),
                                                            agreement(value, other[x].value)};
            }
            above.swap(row);
            row.swap(below);
        }
        return moments;
    }

    // The row that many after row y, or zeros if there is none.
    std::vector<Difference> neighbours(uint32_t y, int step) const {
        const int64_t row = int64_t{y} + step;
        return row >= 0 && row < int64_t{size_.y} ? differences(uint32_t(row))
                                                  : std::vector<Difference>(size_.x);
    }

    std::vector<Difference> differences(uint32_t y) const {
        std::vector<Difference> row(size_.x);
        for (uint32_t x = 0; x < size_.x; ++x)
            row[x] = difference(x, y);
        return row;
    }

    // The variance of a channel. Few samples tell it by what they found, and tell 0 if they found nothing: it
    // is raised to the mean of those around that the denoiser takes for similar, by Tukey's biweight.
    double variance_at(size_t c, uint32_t x, uint32_t y) const {
        const size_t i = size_t(y) * size_.x + x;
        const double own = variance_[c][i];
        if (belief_.neighbours_share == 0.0) return own;
        const double value = denoised_.rgb[c][i], square = value * value;
        const double per_range =
            1.0 / std::max(SIMILAR * SIMILAR * square, std::numeric_limits<double>::min());
        double sum = 0.0, weights = 0.0;
        for (uint32_t v = std::max(y, RADIUS) - RADIUS; v < std::min(y + RADIUS + 1, size_.y); ++v) {
            for (uint32_t u = std::max(x, RADIUS) - RADIUS; u < std::min(x + RADIUS + 1, size_.x); ++u) {
                const size_t j = size_t(v) * size_.x + u;
                const double difference = double(denoised_.rgb[c][j]) - value, variance = variance_[c][j];
                const double similar = 1.0 - difference * difference * per_range;
                if (!(similar > 0.0) || !std::isfinite(variance)) continue;
                const double weight = WINDOW[u + RADIUS - x] * WINDOW[v + RADIUS - y] * similar * similar;
                sum += weight * std::min(variance, VARIANCE_LIMIT * square);
                weights += weight;
            }
        }
        return own + belief_.neighbours_share * std::max(0.0, sum / weights - own);
    }

    Difference difference(uint32_t x, uint32_t y) const {
        const size_t i = size_t(y) * size_.x + x;
        Difference result;
        if (!level_.holds(rgb_at(noisy_, i)) || !is_finite_at(variance_, i) ||
            !is_finite_at(denoised_.rgb, i))
            return result;
        for (int c = 0; c < 3; ++c) {
            const double value = denoised_.rgb[size_t(c)][i], variance = variance_at(size_t(c), x, y);
            const double level = value * value + variance + darkness_;
            if (level <= 0.0) continue;
            result.value[c] = (value - double(noisy_[size_t(c)][i])) / std::sqrt(level);
            result.noise += others(i) * variance / level;
        }
        return result;
    }

    // The share of a window's squared differences that noise does not explain.
    double unexplained_of(const Moments& sum) const {
        if (sum.noise <= 0.0) return 1.0;
        return sum.square > 0.0 ? 1.0 - belief_.noise_share * sum.noise / sum.square : 0.0;
    }

    // The share by which neighbours agree.
    double agreeing_of(const Moments& sum) const {
        const double products = std::max(sum.beside.beyond_chance(), sum.below.beyond_chance());
        return sum.square > 0.0 ? belief_.agreement_gain * products / sum.square : 0.0;
    }

    // With the share of the window's squared differences that is taken for a bias.
    float weight(size_t i, const Moments& sum, double share) const {
        if (!is_finite_at(denoised_.rgb, i)) return 1.0f;
        if (!level_.holds(rgb_at(noisy_, i)) || !is_finite_at(variance_, i)) return 0.0f;
        if (sum.noise <= 0.0) return 1.0f;
        if (sum.square <= 0.0) return 0.0f;
        const double biased = share * sum.square;
        const double own = noise_over_denoised(i) * sum.weight - OUTLIER * sum.noise;
        const double as_outlier = biased / std::max(sum.square, biased + belief_.noise_share * own);
        return float(std::max(as_outlier, std::min(share, unexplained_alone(i))));
    }

    // The share of a pixel's squared difference that its own noise does not explain.
    double unexplained_alone(size_t i) const {
        double square = 0.0, noise = 0.0;
        for (size_t c = 0; c < 3; ++c) {
            square += std::pow(double(denoised_.rgb[c][i]) - double(noisy_[c][i]), 2.0);
            noise += belief_.single_share * double(variance_[c][i]);
        }
        return square > noise ? 1.0 - noise / square : 0.0;
    }

    // The variance relative to the denoised value alone, of all channels.
    double noise_over_denoised(size_t i) const {
        double noise = 0.0;
        for (size_t c = 0; c < 3; ++c) {
            const double value = denoised_.rgb[c][i], level = value * value + darkness_;
            if (level > 0.0) noise += others(i) * double(variance_[c][i]) / level;
        }
        return noise;
    }

    // The share of others in the denoised value.
    double others(size_t i) const {
        return denoised_.own_weight.empty() ? 1.0 : 1.0 - double(denoised_.own_weight[i]);
    }

    uvec2 size_;
    const RgbPlanes& noisy_;
    const RgbPlanes& variance_;
    const Denoised& denoised_;
    PictureLevel level_;
    double darkness_;
    Belief belief_;
};

}  // namespace

std::vector<float> noisy_weights(uvec2 size, const RgbPlanes& noisy, const RgbPlanes& variance,
                                 const Denoised& denoised, double samples_per_pixel) {
    std::vector<float> weights(size_t(size.x) * size.y);
    assert(denoised.rgb[0].size() == weights.size());
    const Weights rows(size, noisy, variance, denoised, samples_per_pixel);
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

// 0 if unknown.
static double mean_samples(const NoisyPicture& picture) {
    double sum = 0.0;
    for (const float samples : picture.samples)
        sum += std::isfinite(samples) ? double(samples) : 0.0;
    return picture.samples.empty() ? 0.0 : sum / double(picture.samples.size());
}

void blend_with(const NoisyPicture& noisy, Denoised& denoised) {
    if (!noisy.variance) return;
    const std::vector<float> weights =
        noisy_weights(noisy.size, noisy.rgb, *noisy.variance, denoised, mean_samples(noisy));
    blend(weights, noisy.rgb, noisy.alpha, denoised);
}

}  // namespace candela
