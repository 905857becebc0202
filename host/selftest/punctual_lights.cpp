// Samples of point, spot and directional lights: they are chosen by power, and values and occlusion are as in
// double precision.
#include <algorithm>
#include <cmath>

#include "base/statistics.h"
#include "base/text.h"
#include "probe/random.h"
#include "probe/scenes.h"
#include "selftest/lights.h"

namespace candela {
namespace {

constexpr double INNER = 0.35;
constexpr double OUTER = 0.85;
const vec3 EMISSION(0.5f);

const PointLight POINT{.position = dvec3(0.25, 0.5, 2), .intensity = vec3(3, 2, 1)};
const SpotLight SPOT{.position = dvec3(-0.5, 0.25, 3),
                     .direction = dvec3(0.5, -0.25, -2),
                     .intensity = vec3(4, 5, 6),
                     .cone = {.inner_angle = float(INNER), .outer_angle = float(OUTER)}};
const DirectionalLight SUN{.direction = dvec3(0.5, 0.25, -1), .irradiance = vec3(0.5f, 0.75f, 1)};

// Lights without a surface above and below a square in the plane z = 0, |x|, |y| <= 1, which emits to both
// sides if there is `emission`.
Scene scene_of_lights(std::vector<Light> lights, std::optional<Emission> emission) {
    Scene scene = scene_of_mesh({});
    scene.shapes.clear();
    add_shape(scene, parallelogram(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0)), 0, emission);
    scene.lights = std::move(lights);
    return scene;
}

// Points around the square, at least 0.01 from its plane.
std::vector<LightItem> random_items(size_t count, uint32_t seed) {
    Random random(seed);
    std::vector<LightItem> items = random_light_items(vec3(0), count, seed + 1);
    for (LightItem& item : items) {
        item.from = 4.0f * random.cube();
        item.from.z = std::copysign(std::max(std::abs(item.from.z), 0.01f), item.from.z);
    }
    return items;
}

// The factor of a spot's intensity, as in the text of glTF's KHR_lights_punctual.
double falloff(double cosine) {
    const double scale = 1.0 / (std::cos(INNER) - std::cos(OUTER));
    const double offset = -std::cos(OUTER) * scale;
    const double attenuation = std::clamp(cosine * scale + offset, 0.0, 1.0);
    return attenuation * attenuation;
}

// The light that arrives without occlusion.
struct Arriving {
    dvec3 wi;
    dvec3 Li;
    double distance;     // Infinite for the sun.
    double error = 0.0;  // Error of Li, relative to the greatest that the light could send.
};

Arriving arriving(const PointLight& light, dvec3 from) {
    const dvec3 to_light = light.position - from;
    const double distance = length(to_light);
    return {to_light / distance, dvec3(light.intensity) / (distance * distance), distance};
}

// The falloff has twice the error of its root, which is that of the cosine times scale. The cosine is off by
// some roundings: those of the direction's and the axis's components, and of the squared chord.
Arriving arriving(const SpotLight& light, dvec3 from) {
    Arriving a = arriving(PointLight{light.position, light.intensity}, from);
    a.error = 2.0 * 0x1p-20 / (std::cos(INNER) - std::cos(OUTER));
    a.Li *= falloff(dot(-a.wi, normalize(light.direction)));
    return a;
}

Arriving arriving(const DirectionalLight& light, dvec3) {
    return {-normalize(light.direction), dvec3(light.irradiance), INFINITY};
}

// Whether the square is in between; nothing if its edge is too close to decide.
std::optional<bool> is_hidden(const Arriving& light, dvec3 from) {
    const double t = -from.z / light.wi.z;
    if (!(t > 0.0 && t < light.distance)) return false;
    const dvec3 p = from + t * light.wi;
    const double edge = std::max(std::abs(p.x), std::abs(p.y)) - 1.0;
    if (std::abs(edge) < 1e-4) return std::nullopt;
    return edge < 0.0;
}

// Li has the error of an inverse square root of 2 roundings, twice, and of some products.
bool is_right(const LightItem& item, const LightSample& s, const Arriving& light, const PointLight& brightest,
              double pmf) {
    if (s.delta != 1 || !(std::abs(double(s.pdf) - pmf) <= 0x1p-22 * pmf)) return false;
    if (!(length(dvec3(s.wi) - light.wi) <= 0x1p-20)) return false;
    const dvec3 greatest =
        light.error == 0.0 ? light.Li : dvec3(brightest.intensity) / (light.distance * light.distance);
    const dvec3 allowed = 0x1p-20 * light.Li + light.error * greatest;
    if (!glm::all(glm::lessThanEqual(abs(dvec3(s.Li) - light.Li), allowed))) return false;
    const bool endless = std::isinf(light.distance);
    const dvec3 end = endless ? light.wi : light.distance * light.wi;
    if (!(length(dvec3(s.shadow) - end) <= 0x1p-20 * length(end))) return false;
    if (endless ? s.t_max != FLOAT_MAX : !(s.t_max < 1.0f && s.t_max >= 1.0f - 0x1p-19f)) return false;
    const std::optional<bool> hidden = is_hidden(light, dvec3(item.from));
    return !hidden || s.occluded == (*hidden ? 1u : 0u);
}

// The light of a sample, by its direction. Lights are further apart than that, except for a few points, for
// which it does not matter.
size_t light_of(const LightSample& s, const std::array<Arriving, 3>& lights) {
    size_t best = 0;
    for (size_t i = 1; i < lights.size(); ++i) {
        if (length(dvec3(s.wi) - lights[i].wi) < length(dvec3(s.wi) - lights[best].wi)) best = i;
    }
    return best;
}

std::string describe(size_t light, const LightItem& item, const LightSample& s) {
    return concat("punctual light ", light, " from ", item.from.x, ' ', item.from.y, ' ', item.from.z,
                  ": wi ", s.wi.x, ' ', s.wi.y, ' ', s.wi.z, ", Li ", s.Li.x, ' ', s.Li.y, ' ', s.Li.z,
                  ", pdf ", s.pdf, ", delta ", s.delta, ", t_max ", s.t_max, ", occluded ", s.occluded);
}

double lamp_luminance(vec3 rgb) {
    return 0.2126 * double(rgb.x) + 0.7152 * double(rgb.y) + 0.0722 * double(rgb.z);
}

// Powers of the point, the spot, the sun and the square, over pi. The mean of a spot's falloff over the
// directions of its soft edge is a third; the sun shines onto a disk as wide as the sphere around the square,
// whose squared radius is 2.
std::array<double, 4> powers() {
    const double inner = 1.0 - std::cos(INNER), outer = 1.0 - std::cos(OUTER);
    return {4.0 * lamp_luminance(POINT.intensity),
            2.0 * (inner + (outer - inner) / 3.0) * lamp_luminance(SPOT.intensity),
            2.0 * lamp_luminance(SUN.irradiance), 2.0 * 4.0 * lamp_luminance(EMISSION)};
}

// Tests samples of the point, spot and directional light; `pmf` has their probabilities. Returns how often
// each was chosen.
std::array<double, 4> test_samples(const vk::Device& device, const Scene& scene,
                                   const std::array<double, 3>& pmf, size_t count, SceneAccess access,
                                   Evidence& evidence) {
    std::array<double, 4> chosen{};
    const std::vector<LightItem> items = random_items(count, 260);
    const std::vector<LightSample> samples =
        sample_lights(device, build_gpu_scene(scene, SceneFrame{}), items, access);
    const PointLight brightest{SPOT.position, SPOT.intensity};
    for (size_t k = 0; k < items.size(); ++k) {
        const LightSample& s = samples[k];
        if (s.delta == 0) {
            ++chosen[3];
            continue;
        }
        const dvec3 from(items[k].from);
        const std::array<Arriving, 3> lights{arriving(POINT, from), arriving(SPOT, from),
                                             arriving(SUN, from)};
        const size_t i = light_of(s, lights);
        ++chosen[i];
        evidence.expect(is_right(items[k], s, lights[i], brightest, pmf[i]),
                        [&] { return describe(i, items[k], s); });
    }
    return chosen;
}

}  // namespace

Evidence test_punctual_lights(const vk::Device& device, Effort effort) {
    Evidence evidence;
    const std::vector<Light> all{{"", POINT}, {"", SPOT}, {"", SUN}};
    const std::array<double, 4> power = powers();
    const double total = power[0] + power[1] + power[2] + power[3];
    const Scene scene = scene_of_lights(all, Emission{.radiance = EMISSION, .two_sided = true});
    const std::array<double, 4> chosen =
        test_samples(device, scene, {power[0] / total, power[1] / total, power[2] / total},
                     sized(effort, 100000), SceneAccess::texel_buffers, evidence);
    evidence.add_p_value("choice among punctual lights", pearson_p_value(chosen, power));
    for (size_t i = 0; i < all.size(); ++i) {
        const std::array<double, 4> only =
            test_samples(device, scene_of_lights({all[i]}, {}), {1.0, 1.0, 1.0}, sized(effort, 2000),
                         SceneAccess::storage_buffers, evidence);
        evidence.expect(only[i] == double(sized(effort, 2000)),
                        [&] { return concat("a sample is not of the only light ", i); });
    }
    return evidence;
}

}  // namespace candela
