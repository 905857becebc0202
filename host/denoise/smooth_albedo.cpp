// See smooth_albedo.h.
#include "denoise/smooth_albedo.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/parallel.h"
#include "denoise/level.h"

namespace candela {
namespace {

constexpr int WINDOW_RADIUS = 2;
constexpr int PATCH_RADIUS = 1;  // Of what is compared.
constexpr int MARGIN = WINDOW_RADIUS + PATCH_RADIUS;
constexpr int SMOOTHED_ROWS = 32;  // That one step smooths.
// Added to variances: squared differences of albedo, all channels together, that nobody sees.
constexpr float VARIANCE_FLOOR = 1e-3f;

struct Feature {
    vec3 albedo{0.0f};
    float variance = -1.0f;  // Below 0: nothing is known.
};

Feature feature_of(const NoisyPicture& picture, size_t i) {
    const vec3 albedo = rgb_at(*picture.albedo, i);
    const float variance = picture.albedo_variance[i];
    if (!is_finite(albedo) || !std::isfinite(variance) || variance < 0.0f) return {};
    return {albedo, variance};
}

// A part of the picture with a margin, which has no features beyond the picture's edges.
class Strip {
  public:
    Strip(const NoisyPicture& picture, const PixelRect& rect)
        : width_(int(rect.width())),
          height_(int(rect.height())),
          pitch_(width_ + 2 * MARGIN),
          features_(size_t(pitch_) * size_t(height_ + 2 * MARGIN)) {
        const int left = int(rect.x0) - MARGIN, top = int(rect.y0) - MARGIN;
        const int x1 = std::min(left + pitch_, int(picture.size.x));
        const int y1 = std::min(int(rect.y1) + MARGIN, int(picture.size.y));
        for (int y = std::max(top, 0); y < y1; ++y) {
            for (int x = std::max(left, 0); x < x1; ++x)
                features_[index(x - left, y - top)] =
                    feature_of(picture, size_t(y) * picture.size.x + size_t(x));
        }
    }

    // Calls put(x, y, albedo) for all pixels that have a variance.
    template <class Put>
    void smooth(const Put& put) {
        std::vector<vec4> sums(size_t(width_) * size_t(height_), vec4(0.0f));  // rgb: albedos; a: weights.
        for (int dy = -WINDOW_RADIUS; dy <= WINDOW_RADIUS; ++dy) {
            for (int dx = -WINDOW_RADIUS; dx <= WINDOW_RADIUS; ++dx)
                add_shifted(dx, dy, sums);
        }
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const vec4& sum = sums[size_t(y) * size_t(width_) + size_t(x)];
                if (at(x, y).variance > 0.0f) put(x, y, vec3(sum) / sum.w);
            }
        }
    }

  private:
    // The difference of two pixels beyond what their variances explain, and 1; zeros if one is unknown.
    struct Unlikeness {
        float value = 0.0f, count = 0.0f;
    };
    static Unlikeness compare(const Feature& a, const Feature& b) {
        if (a.variance < 0.0f || b.variance < 0.0f) return {};
        const vec3 difference = a.albedo - b.albedo;
        const float excess = glm::dot(difference, difference) - a.variance - std::min(a.variance, b.variance);
        return {excess / (VARIANCE_FLOOR + a.variance + b.variance), 1.0f};
    }

    void add_shifted(int dx, int dy, std::vector<vec4>& sums) const {
        // Of the rows from -PATCH_RADIUS on, each with a margin; sums of columns.
        const int pitch = width_ + 2 * PATCH_RADIUS;
        std::vector<Unlikeness> rows, columns;
        rows.resize(size_t(pitch) * size_t(height_ + 2 * PATCH_RADIUS));
        columns.resize(size_t(pitch));
        auto out = rows.begin();
        for (int y = -PATCH_RADIUS; y < height_ + PATCH_RADIUS; ++y) {
            for (int x = -PATCH_RADIUS; x < width_ + PATCH_RADIUS; ++x)
                *out++ = compare(at(x, y), at(x + dx, y + dy));
        }
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < pitch; ++x) {
                columns[size_t(x)] = {};
                for (int row = y; row <= y + 2 * PATCH_RADIUS; ++row)
                    add(columns[size_t(x)], rows[size_t(row) * size_t(pitch) + size_t(x)]);
            }
            for (int x = 0; x < width_; ++x) {
                const Feature& other = at(x + dx, y + dy);
                if (at(x, y).variance <= 0.0f || other.variance < 0.0f) continue;
                Unlikeness patch;
                for (int column = x; column <= x + 2 * PATCH_RADIUS; ++column)
                    add(patch, columns[size_t(column)]);
                const float weight = std::exp(-std::max(0.0f, patch.value / patch.count));
                sums[size_t(y) * size_t(width_) + size_t(x)] += weight * vec4(other.albedo, 1.0f);
            }
        }
    }
    static void add(Unlikeness& sum, const Unlikeness& other) {
        sum.value += other.value;
        sum.count += other.count;
    }

    size_t index(int x, int y) const { return size_t(y) * size_t(pitch_) + size_t(x); }
    const Feature& at(int x, int y) const { return features_[index(x + MARGIN, y + MARGIN)]; }

    int width_, height_, pitch_;
    std::vector<Feature> features_;
};

}  // namespace

std::vector<vec3> smooth_albedo(const NoisyPicture& picture, const PixelRect& rect) {
    assert(picture.albedo);
    std::vector<vec3> result;
    result.reserve(size_t{rect.width()} * rect.height());
    for (uint32_t y = rect.y0; y < rect.y1; ++y) {
        for (uint32_t x = rect.x0; x < rect.x1; ++x)
            result.push_back(rgb_at(*picture.albedo, size_t{y} * picture.size.x + x));
    }
    if (picture.albedo_variance.empty()) return result;
    const uint32_t rows = uint32_t(SMOOTHED_ROWS);
    parallel_for((rect.height() + rows - 1) / rows, [&](size_t i) {
        const uint32_t y0 = rect.y0 + uint32_t(i) * rows;
        const PixelRect part{rect.x0, y0, rect.x1, std::min(y0 + rows, rect.y1)};
        Strip(picture, part).smooth([&](int x, int y, vec3 albedo) {
            result[size_t(y0 - rect.y0 + uint32_t(y)) * rect.width() + size_t(x)] = albedo;
        });
    });
    return result;
}

}  // namespace candela
