// See relative_error.h.
#include "image/relative_error.h"

#include <algorithm>
#include <cmath>

namespace candela {
namespace {

constexpr double DARKNESS = 0.01;  // Times the square of the mean, added to a pixel's square.

double mean_of(const RgbPlanes& planes) {
    double sum = 0.0;
    for (const auto& plane : planes) {
        for (const float value : plane)
            sum += value;
    }
    return sum / double(3 * planes[0].size());
}

bool is_doubled(const Image& before, const Image& now) {
    const auto& m = before.find("SampleCount.V")->values;
    const auto& n = now.find("SampleCount.V")->values;
    for (size_t i = 0; i < n.size(); ++i) {
        if (m[i] < 1.0f || n[i] != 2.0f * m[i]) return false;
    }
    return true;
}

// Mean of the up to eight values around value i of a row-major plane; that value if there are none.
double mean_of_neighbours(std::span<const float> plane, const PixelRect& rect, size_t i) {
    const size_t width = rect.width(), x = i % width, y = i / width;
    double sum = -double(plane[i]);
    int count = -1;
    for (size_t row = y - std::min<size_t>(y, 1); row <= std::min<size_t>(y + 1, rect.height() - 1); ++row) {
        for (size_t column = x - std::min<size_t>(x, 1); column <= std::min(x + 1, width - 1); ++column) {
            sum += plane[row * width + column];
            ++count;
        }
    }
    return count > 0 ? sum / count : double(plane[i]);
}

}  // namespace

double darkness_of(const RgbPlanes& reference) {
    const double mean = mean_of(reference);
    return DARKNESS * mean * mean;
}

double relative_mse(const RgbPlanes& image, const RgbPlanes& reference) {
    const double darkness = darkness_of(reference);
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < image[c].size(); ++i) {
            const double r = reference[c][i], error = image[c][i] - r;
            sum += error * error / (r * r + darkness);
        }
    }
    return sum / double(3 * image[0].size());
}

// A pixel's movement is relative to its own value or the mean of its neighbours, whichever is darker: a
// single bright sample would raise its own pixel and so hide its own error, and neighbours alone would
// mislead at edges.
std::optional<double> estimate_relative_error_by_half(const Image& half, const Image& mean) {
    const RgbPlanes first = *half.find_rgb(), both = *mean.find_rgb();
    const double darkness = darkness_of(both);
    if (!(darkness > 0.0)) return std::nullopt;
    double sum = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < both[c].size(); ++i) {
            const double x = both[c][i], moved = x - first[c][i];
            const double r = std::min(x, mean_of_neighbours(both[c], mean.data, i));
            sum += moved * moved / (r * r + darkness);
        }
    }
    return std::sqrt(sum / double(3 * both[0].size()));
}

std::optional<double> estimate_relative_error(const Image& before, const Image& now) {
    return is_doubled(before, now) ? estimate_relative_error_by_half(before, now) : std::nullopt;
}

}  // namespace candela
