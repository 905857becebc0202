// Filtering by variance in double precision: the passes of shaders/kernels/denoise.comp.glsl as plain loops
// over a whole picture without albedo and in its own unit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/math.h"

namespace candela {

struct ReferencePixel {
    dvec3 value{0.0}, variance{0.0};
    double own_weight = 1.0;
    bool is_there = true;
};

struct ReferencePicture {
    int width, height;
    std::vector<ReferencePixel> pixels;
    std::vector<dvec4> normals;  // w: variance.

    bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    size_t at(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }
};

// Calls visit(neighbour, weight of the spline) for the pixels that a pass looks at.
inline void for_neighbours(const ReferencePicture& picture, size_t i, int step,
                           const std::function<void(size_t, double)>& visit) {
    constexpr std::array SPLINE{0.0625, 0.25, 0.375, 0.25, 0.0625};
    const int x = int(i) % picture.width, y = int(i) / picture.width;
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            if (picture.is_inside(x + dx * step, y + dy * step))
                visit(picture.at(x + dx * step, y + dy * step),
                      SPLINE[size_t(dx + 2)] * SPLINE[size_t(dy + 2)]);
        }
    }
}

inline double normal_distance(const ReferencePicture& picture, size_t i, size_t j) {
    const dvec3 difference = dvec3(picture.normals[i]) - dvec3(picture.normals[j]);
    const double noise = picture.normals[i].w + picture.normals[j].w;
    return std::max(0.0, dot(difference, difference) - noise) / (0.09 + noise);
}

// The pass that smooths the variance; every pixel of the picture has one, or has no value.
inline std::vector<ReferencePixel> smoothed_variance(const ReferencePicture& picture) {
    std::vector<ReferencePixel> result = picture.pixels;
    for (size_t i = 0; i < result.size(); ++i) {
        const ReferencePixel& own = picture.pixels[i];
        if (!own.is_there) continue;
        dvec3 local(0.0), greatest(0.0), sum(0.0);
        double count = 0.0, weights = 0.0;
        const int x = int(i) % picture.width, y = int(i) / picture.width;
        for (int v = y - 1; v <= y + 1; ++v) {
            for (int u = x - 1; u <= x + 1; ++u) {
                if (!picture.is_inside(u, v) || !picture.pixels[picture.at(u, v)].is_there) continue;
                const dvec3& value = picture.pixels[picture.at(u, v)].value;
                local += value;
                greatest = max(greatest, value);
                count += 1.0;
            }
        }
        const dvec3 level = 0.5 * max(own.value, (local - greatest) / std::max(count - 1.0, 1.0));
        const dvec3 limit = 4.0 * max(own.variance, level * level);
        for_neighbours(picture, i, 1, [&](size_t j, double) {
            if (!picture.pixels[j].is_there) return;
            const double weight = std::exp(-normal_distance(picture, i, j));
            sum += weight * min(picture.pixels[j].variance, limit);
            weights += weight;
        });
        result[i].variance = 0.2 * own.variance + 0.8 * sum / weights;
    }
    return result;
}

// The pass that filters. `guide` may be `source`.
inline std::vector<ReferencePixel> filtered(const ReferencePicture& picture,
                                            const std::vector<ReferencePixel>& source,
                                            const std::vector<ReferencePixel>& guide, int step,
                                            double tolerance, double outlier) {
    std::vector<ReferencePixel> result(source.size());
    for (size_t i = 0; i < result.size(); ++i) {
        double weights = 0.0, own_weight = 0.0;
        dvec3 sum(0.0), variance_sum(0.0);
        for_neighbours(picture, i, step, [&](size_t j, double weight) {
            if (!source[j].is_there) return;
            if (i == j) {
                own_weight = weight * source[i].own_weight;
            } else {
                double distance = normal_distance(picture, i, j);
                if (guide[i].is_there && guide[j].is_there) {
                    const dvec3 d = guide[i].value - guide[j].value, a = guide[i].variance,
                                b = guide[j].variance;
                    const dvec3 excess = max(dvec3(0.0), d * d - a - min(a, b));
                    const dvec3 expected = tolerance * (a + min(b, outlier * a)) + 1e-8;
                    distance += (excess.x / expected.x + excess.y / expected.y + excess.z / expected.z) / 3.0;
                }
                weight *= std::exp(-distance);
            }
            weights += weight;
            sum += weight * source[j].value;
            variance_sum += weight * weight * source[j].variance;
        });
        result[i] = {sum / weights, variance_sum / (weights * weights), own_weight / weights, weights > 0.0};
        if (weights == 0.0) result[i].value = source[i].value;
    }
    return result;
}

// All passes. After each, `round` may change what a pass of less precision would have rounded.
inline std::vector<ReferencePixel> filtered_by_reference(const ReferencePicture& picture,
                                                         const std::function<double(double)>& round) {
    const auto rounded = [&](std::vector<ReferencePixel> pixels) {
        for (ReferencePixel& pixel : pixels) {
            for (int c = 0; c < 3; ++c) {
                pixel.value[c] = round(pixel.value[c]);
                pixel.variance[c] = round(pixel.variance[c]);
            }
        }
        return pixels;
    };
    const std::vector<ReferencePixel> noisy = rounded(smoothed_variance(picture));
    const std::vector<ReferencePixel> guide = rounded(filtered(picture, noisy, noisy, 1, 16.0, 1000.0));
    std::vector<ReferencePixel> result = rounded(filtered(picture, noisy, guide, 1, 4.0, 1.0));
    for (const int step : {2, 4, 8})
        result = rounded(filtered(picture, result, result, step, 4.0, 1.0));
    return result;
}

}  // namespace candela
