// See environment_map.h.
#include "gpu_scene/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/color.h"
#include "gpu_scene/alias_table.h"
#include "gpu_scene/append.h"

namespace candela {
namespace {

// Solid angle of a texel in that row [sr]: 2 pi / width (cos(theta_0) - cos(theta_1)), without cancellation.
double texel_solid_angle(uvec2 size, uint32_t row) {
    const double step = std::numbers::pi / size.y;
    return 4.0 * std::numbers::pi / size.x * std::sin((row + 0.5) * step) * std::sin(0.5 * step);
}

}  // namespace

EnvironmentMap build_environment_map(const Environment& environment) {
    const uvec2 size = environment.size;
    EnvironmentMap map;
    std::vector<double> weights;
    weights.reserve(environment.radiance.size());
    for (uint32_t y = 0; y < size.y; ++y) {
        const double solid_angle = texel_solid_angle(size, y);
        for (uint32_t x = 0; x < size.x; ++x)
            weights.push_back(luminance(environment.radiance[size_t(y) * size.x + x]) * solid_angle);
    }
    map.irradiance = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (map.irradiance > 0.0) map.alias = build_alias_table(weights);
    map.even = std::ranges::all_of(environment.radiance,
                                   [&](vec3 radiance) { return radiance == environment.radiance[0]; });
    map.texels.reserve(environment.radiance.size());
    for (const vec3 radiance : environment.radiance) {
        const double pdf = map.irradiance > 0.0 ? luminance(radiance) / map.irradiance : 0.0;
        map.texels.push_back({radiance, float(pdf)});
    }
    return map;
}

SkyArrays build_sky_arrays(const Environment& environment, EnvironmentMap map, bool is_light) {
    SkyArrays arrays{.facts = {.environment = environment.visible ? ENVIRONMENT_VISIBLE : ENVIRONMENT_HIDDEN,
                               .even_sky = map.even,
                               .environment_size = environment.size,
                               .environment_rotation = environment.rotation},
                     .texels = {},
                     .alias = pack_alias_table(map.alias)};
    for (EnvironmentTexel& texel : map.texels) {
        if (!is_light) texel.pdf = 0.0f;
        append(arrays.texels, pack(texel));
    }
    return arrays;
}

}  // namespace candela
