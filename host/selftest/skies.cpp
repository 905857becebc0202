// See skies.h.
#include "selftest/skies.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/statistics.h"
#include "base/text.h"
#include "probe/probe.h"
#include "probe/probes.h"
#include "probe/random.h"
#include "probe/scenes.h"
#include "selftest/histogram.h"
#include "selftest/lights.h"

namespace candela {
namespace {

Environment random_sky(uvec2 size, float rotation) {
    Random random(size.x * 1000 + size.y);
    Environment sky{.size = size, .radiance = {}, .rotation = rotation};
    for (uint32_t i = 0; i < size.x * size.y; ++i) {
        const float scale = std::exp2(6.0f * random.unit());
        sky.radiance.push_back(scale * (vec3(1.1f) + random.cube()));
    }
    if (sky.radiance.size() > 2) sky.radiance[1] = vec3(0.0f);
    return sky;
}

double luminance_of(vec3 rgb) {
    return 0.2126 * double(rgb.x) + 0.7152 * double(rgb.y) + 0.0722 * double(rgb.z);
}

// The place of a direction in the map, in texels from its top left, as scene.h describes it: the centre is
// towards -Z, u grows to +X and v downwards from +Y; the map was turned about +Y, which turns -Z towards -X.
glm::dvec2 place_of(const Environment& sky, glm::dvec3 w) {
    const double longitude = std::atan2(w.x, -w.z) + double(sky.rotation);  // From -Z towards +X.
    const double colatitude = std::atan2(std::hypot(w.x, w.z), w.y);
    const double u = 0.5 + longitude / (2.0 * M_PI);
    return {(u - std::floor(u)) * sky.size.x, colatitude / M_PI * sky.size.y};
}

// The texel at a place.
size_t texel_of(const Environment& sky, glm::dvec2 place) {
    const auto index = [](double x, uint32_t size) {
        return x > 0.0 ? std::min(size_t(std::min(x, double(size))), size_t{size - 1}) : 0;
    };
    return index(place.y, sky.size.y) * sky.size.x + index(place.x, sky.size.x);
}

// Whether a direction is so close to a border between texels that rounding may put it on either side. The
// longitude is off by 2^-22 turns and by `rounding`, the error of its arguments, over their size; the
// colatitude by `colatitude` of its range.
bool at_border(const Environment& sky, glm::dvec3 w, double rounding, double colatitude) {
    const auto to_border = [](double x) { return std::abs(x - std::round(x)); };
    const glm::dvec2 place = place_of(sky, w);
    const double turns = 0x1p-22 + rounding / std::max(std::hypot(w.x, w.z), 1e-9);
    return to_border(place.x) < sky.size.x * turns || to_border(place.y) < sky.size.y * colatitude;
}

// All around, on the axes and at the poles.
std::vector<vec3> directions_all_around() {
    std::vector<vec3> directions;
    Random random(90);
    for (int i = 0; i < 50000; ++i)
        directions.push_back(random.direction());
    for (const float sign : {-1.0f, 1.0f}) {
        for (const int axis : {0, 1, 2}) {
            vec3 w(0.0f);
            w[axis] = sign;
            directions.push_back(w);
        }
        directions.push_back(normalize(vec3(1e-7f, sign, 1e-7f)));
        directions.emplace_back(1e-30f, sign, 0.0f);
    }
    return directions;
}

// The expected distribution of samples of a sky, and their counts.
struct SkyCounts {
    explicit SkyCounts(const Environment& sky) : texels(sky.radiance.size()), within(8) {
        std::vector<double> angles;
        for (size_t i = 0; i < sky.radiance.size(); ++i) {
            const size_t row = i / sky.size.x;
            const double step = M_PI / sky.size.y, top = step * double(row);
            angles.push_back(2.0 * M_PI / sky.size.x * (std::cos(top) - std::cos(top + step)));
            mean += luminance_of(sky.radiance[i]) * angles.back() / (4.0 * M_PI);
        }
        for (size_t i = 0; i < sky.radiance.size(); ++i) {
            light.push_back(above_mean(sky.radiance[i]) * angles[i]);
            irradiance += light.back();
        }
    }
    double above_mean(vec3 radiance) const { return std::max(luminance_of(radiance) - mean, 0.0); }
    void add(const Environment& sky, glm::dvec2 place) {
        ++texels[texel_of(sky, place)];
        const double row = std::floor(place.y), step = M_PI / sky.size.y;
        const double top = std::cos(step * row), bottom = std::cos(step * (row + 1.0));
        within.add({place.x - std::floor(place.x), (top - std::cos(step * place.y)) / (top - bottom)});
    }

    double mean = 0.0;          // Luminance, over the sphere.
    std::vector<double> light;  // What each texel has above it.
    double irradiance = 0.0;    // The sum of that.
    std::vector<double> texels;
    Histogram within;  // Over all texels: columns, and cosines of the colatitude.
};

void test_samples_of(const vk::Device& device, const Environment& sky, uint32_t samples, Evidence& evidence) {
    const std::string name = concat("sky of ", sky.size.x, 'x', sky.size.y);
    SkyCounts counts(sky);
    size_t at_borders = 0;
    for (const LightSample& s : sample_lights(device, build_gpu_scene(scene_under(sky), SceneFrame{}),
                                              random_light_items(vec3(0), samples, 91))) {
        const glm::dvec3 w(s.wi);
        const glm::dvec2 place = place_of(sky, w);
        counts.add(sky, place);
        bool right = std::abs(length(w) - 1.0) <= 0x1p-20;
        if (at_border(sky, w, 0x1p-21, 0x1p-19)) {
            ++at_borders;  // May be counted in the neighbour.
        } else {
            const size_t texel = texel_of(sky, place);
            const double pdf = counts.above_mean(sky.radiance[texel]) / counts.irradiance;
            const double rounding = luminance_of(sky.radiance[texel]) / counts.irradiance * 0x1p-20;
            right = right && std::abs(double(s.pdf) - pdf) <= rounding && s.Li == sky.radiance[texel] &&
                    s.Li_met == s.Li && s.pdf_met == s.pdf && s.occluded == 0;
        }
        evidence.expect(right, [&] {
            return concat(name, ": wi ", s.wi.x, ' ', s.wi.y, ' ', s.wi.z, ", at ", place.x, ' ', place.y,
                          ", pdf ", s.pdf, ", Li ", s.Li.x, ", occluded ", s.occluded, "; met: pdf ",
                          s.pdf_met, ", Li ", s.Li_met.x);
        });
    }
    evidence.expect(at_borders < 200,
                    [&] { return concat(name, ": ", at_borders, " samples are at borders of texels"); });
    // A texel that is not above the mean holds only samples at its borders.
    for (size_t i = 0; i < counts.texels.size(); ++i) {
        if (counts.light[i] > 0.0) continue;
        const double found = std::exchange(counts.texels[i], 0.0);
        evidence.expect(found < 20.0, [&] { return concat(name, ": ", found, " samples in a dark texel"); });
    }
    evidence.add_p_value(name, pearson_p_value(counts.texels, counts.light));
    evidence.add_p_value(name + ", within texels", counts.within.uniformity());
}

}  // namespace

Scene scene_under(const Environment& environment) {
    Scene scene = scene_of_mesh({});
    scene.shapes = {{.geometry = parallelogram(vec3(-0.5f, -1000, -0.5f), vec3(1, 0, 0), vec3(0, 0, 1)),
                     .material = 0,
                     .emission = {}}};
    scene.environment = environment;
    return scene;
}

std::vector<SkyTexel> look_up(const vk::Device& device, const Environment& sky,
                              const std::vector<vec3>& directions) {
    const DeviceScene scene(device, build_gpu_scene(scene_under(sky), SceneFrame{}),
                            SceneAccess::texel_buffers);
    std::vector<vec4> items;
    for (const vec3 w : directions)
        items.emplace_back(w, 0.0f);
    return probe<SkyTexel>(device, kernels::environment, items, {}, &scene);
}

Evidence test_sky_lookup(const vk::Device& device) {
    const std::vector<vec3> directions = directions_all_around();
    Evidence evidence;
    for (const uvec2 size : {uvec2(1, 1), uvec2(1, 5), uvec2(7, 1), uvec2(5, 9), uvec2(128, 64)}) {
        const Environment sky = random_sky(size, 0.7f);
        const std::vector<SkyTexel> texels = look_up(device, sky, directions);
        size_t at_borders = 0;
        for (size_t i = 0; i < directions.size(); ++i) {
            const glm::dvec3 w(directions[i]);
            const bool undecided = at_border(sky, w, 0x1p-22, 0x1p-20);
            at_borders += undecided;
            const bool right = undecided
                                   ? is_finite(texels[i].radiance)
                                   : texels[i].radiance == sky.radiance[texel_of(sky, place_of(sky, w))];
            evidence.expect(right, [&] {
                return concat("sky of ", size.x, 'x', size.y, ": radiance ", texels[i].radiance.x,
                              " towards ", w.x, ' ', w.y, ' ', w.z);
            });
        }
        evidence.expect(at_borders < 500,
                        [&] { return concat(at_borders, " directions are at borders of texels"); });
    }
    return evidence;
}

Evidence test_sky_samples(const vk::Device& device, Effort effort) {
    Evidence evidence;
    for (const uvec2 size : {uvec2(2, 1), uvec2(1, 5), uvec2(7, 1), uvec2(5, 9), uvec2(32, 16)})
        test_samples_of(device, random_sky(size, -2.5f), sized(effort, 200000), evidence);
    return evidence;
}

// A panel of one square metre beside a sky, half of which is 0.5 above its mean: their powers, over pi, are
// 10 and (0.71 m)^2 * pi.
Evidence test_choice_of_sky(const vk::Device& device, Effort effort) {
    Scene scene = scene_of_mesh({});
    scene.shapes = {{.geometry = parallelogram(vec3(-0.5f, -10, 0.5f), vec3(1, 0, 0), vec3(0, 0, -1)),
                     .material = 0,
                     .emission = Emission{.radiance = vec3(10), .two_sided = false}}};
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(0.5f), vec3(1.5f)}};
    const double sky_power = 0.5 * M_PI, pmf = sky_power / (10.0 + sky_power);
    std::vector<double> counts(2);
    Evidence evidence;
    for (const LightSample& s : sample_lights(device, build_gpu_scene(scene, SceneFrame{}),
                                              random_light_items(vec3(0), sized(effort, 100000), 92))) {
        const bool of_the_sky = s.Li.x == 1.5f;
        ++counts[of_the_sky ? 1 : 0];
        const double pdf = pmf / (2.0 * M_PI);
        evidence.expect(!of_the_sky || std::abs(double(s.pdf) - pdf) <= 0x1p-22,
                        [&] { return concat("the sky beside a panel: pdf ", s.pdf); });
    }
    evidence.add_p_value("choice between sky and panel",
                         pearson_p_value(counts, std::vector{1.0 - pmf, pmf}));
    return evidence;
}

}  // namespace candela
