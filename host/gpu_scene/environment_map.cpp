// See environment_map.h.
#include "gpu_scene/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "base/color.h"
#include "gpu_scene/append.h"
#include "gpu_scene/cdf_table.h"

namespace candela {
namespace {

// Solid angle of a texel in that row [sr]: 2 pi / width (cos(theta_0) - cos(theta_1)), without cancellation.
double texel_solid_angle(uvec2 size, uint32_t row) {
    const double step = std::numbers::pi / size.y;
    return 4.0 * std::numbers::pi / size.x * std::sin((row + 0.5) * step) * std::sin(0.5 * step);
}

// The sky's luminance, averaged over the sphere.
double mean_luminance(const Environment& environment) {
    double sum = 0.0;
    for (uint32_t y = 0; y < environment.size.y; ++y) {
        double row = 0.0;
        for (uint32_t x = 0; x < environment.size.x; ++x)
            row += luminance(environment.radiance[size_t(y) * environment.size.x + x]);
        sum += row * texel_solid_angle(environment.size, y);
    }
    return sum / (4.0 * std::numbers::pi);
}

// The unit directions through the middles of texels, in the map's own axes.
class Directions {
  public:
    explicit Directions(uvec2 size) : height_(size.y) {
        for (uint32_t x = 0; x < size.x; ++x) {
            const double phi = 2.0 * std::numbers::pi * ((x + 0.5) / size.x + 0.5);
            columns_.emplace_back(std::sin(phi), -std::cos(phi));
        }
    }
    void begin_row(uint32_t y) {
        const double theta = std::numbers::pi * (y + 0.5) / height_;
        sine_ = std::sin(theta);
        cosine_ = std::cos(theta);
    }
    // Of a texel in that row.
    dvec3 operator()(uint32_t x) const { return {sine_ * columns_[x].x, cosine_, sine_ * columns_[x].y}; }

  private:
    uint32_t height_;
    std::vector<glm::dvec2> columns_;
    double sine_ = 0.0, cosine_ = 0.0;
};

}  // namespace

EnvironmentMap build_environment_map(const Environment& environment) {
    const uvec2 size = environment.size;
    EnvironmentMap map;
    map.texels.reserve(environment.radiance.size());
    for (const vec3 radiance : environment.radiance)
        map.texels.push_back({radiance, 0.0f});
    map.even = std::ranges::all_of(environment.radiance,
                                   [&](vec3 radiance) { return radiance == environment.radiance[0]; });
    if (map.even) return map;
    const double mean = mean_luminance(environment);
    std::vector<double> weights, rows;  // Of texels and of rows: luminance above the mean times solid angle.
    weights.reserve(environment.radiance.size());
    Directions directions(size);
    for (uint32_t y = 0; y < size.y; ++y) {
        directions.begin_row(y);
        const double solid_angle = texel_solid_angle(size, y);
        rows.push_back(0.0);
        for (uint32_t x = 0; x < size.x; ++x) {
            const double bright = luminance(environment.radiance[size_t(y) * size.x + x]);
            weights.push_back(std::max(bright - mean, 0.0) * solid_angle);
            // The first two bands of max(0, cos) in spherical harmonics.
            map.flux += weights.back() * dvec4(0.5 * directions(x), 0.25);
            rows.back() += weights.back();
        }
    }
    map.irradiance = std::accumulate(rows.begin(), rows.end(), 0.0);
    if (map.irradiance == 0.0) return map;
    const std::vector<uint64_t> row_words = divide_words(rows);
    for (uint32_t y = 0; y < size.y; ++y) {
        const std::span row = std::span(weights).subspan(size_t(y) * size.x, size.x);
        if (row_words[y] == 0) {
            map.cdf.resize(map.cdf.size() + size.x);
            continue;
        }
        const std::vector<uint64_t> words = divide_words(row);
        append_cdf_table(map.cdf, words);
        const double per_word = double(row_words[y]) * 0x1p-64 / texel_solid_angle(size, y);
        for (uint32_t x = 0; x < size.x; ++x)
            map.texels[size_t(y) * size.x + x].pdf = float(per_word * double(words[x]));
    }
    append_cdf_table(map.cdf, row_words);
    return map;
}

SkyArrays build_sky_arrays(const Environment& environment, EnvironmentMap map, bool is_light) {
    SkyArrays arrays{.facts = {.environment = environment.visible ? ENVIRONMENT_VISIBLE : ENVIRONMENT_HIDDEN,
                               .even_sky = map.even,
                               .environment_size = environment.size,
                               .environment_rotation = environment.rotation},
                     .texels = {},
                     .cdf = pack_pairs<CdfEntry>(map.cdf)};
    for (EnvironmentTexel& texel : map.texels) {
        if (!is_light) texel.pdf = 0.0f;
        append(arrays.texels, pack(texel));
    }
    return arrays;
}

void add_dark_sky(SkyArrays& arrays) {
    arrays.facts.environment_size = uvec2(1);
    append(arrays.texels, pack(EnvironmentTexel{}));
    arrays.cdf = pack_pairs<CdfEntry>(std::vector<CdfEntry>(2));
}

}  // namespace candela
