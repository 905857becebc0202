// Samples of flat lights: lights are chosen by power, points uniformly by area, and densities agree.
#include <algorithm>
#include <cmath>

#include "base/statistics.h"
#include "base/text.h"
#include "probe/random.h"
#include "probe/scenes.h"
#include "selftest/histogram.h"
#include "selftest/lights.h"

namespace candela {
namespace {

// The light in a plane, as expected from the scene alone.
struct ExpectedLight {
    vec3 p, e1, e2;
    bool triangle;
    bool two_sided;
    vec3 radiance;

    double area() const { return length(cross(glm::dvec3(e1), glm::dvec3(e2))) * (triangle ? 0.5 : 1.0); }
    double power() const {
        const double luminance = 0.2126 * radiance.x + 0.7152 * radiance.y + 0.0722 * radiance.z;
        return area() * luminance * (two_sided ? 2.0 : 1.0);
    }
};

const std::vector<ExpectedLight> LIGHTS{
    {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 2, 0), false, false, vec3(3, 2, 1)},
    {vec3(0, 0, 1), vec3(1, 0, 0), vec3(0.5f, 1, 0), false, true, vec3(0.1f)},
    {vec3(-1, -1, 2), vec3(3, 0, 0), vec3(0, 3, 0), true, false, vec3(0, 1, 0)},
    {vec3(0, 0, 3), vec3(0.01f, 0, 0), vec3(0, 0.01f, 0), false, false, vec3(5000)},
    {vec3(1, 1, 4), vec3(0, 2, 0), vec3(-2, 0, 0), true, true, vec3(0.2f, 0.3f, 2)},
};

// The light whose plane is closest to the end of the shadow ray, which is at most 256 representable numbers
// away; LIGHTS.size() if there is none.
size_t light_of(const LightItem& item, const LightSample& s) {
    const float z = std::round(item.from.z + s.shadow.z);
    return z >= 0.0f && z < float(LIGHTS.size()) ? size_t(z) : LIGHTS.size();
}

// The point on light i. The shadow ray's end is offset from it only along the normal, z.
glm::dvec3 point_of(const LightItem& item, const LightSample& s, size_t i) {
    return {double(item.from.x) + double(s.shadow.x), double(item.from.y) + double(s.shadow.y), double(i)};
}

// Items for random points above, between and below the lights, at least 0.1 from each plane.
std::vector<LightItem> random_items(size_t count) {
    Random random(60);
    std::vector<LightItem> items = random_light_items(vec3(0), count, 61);
    for (LightItem& item : items) {
        item.from = 5.0f * random.cube();
        item.from.z = std::floor(item.from.z) + 2.1f + 0.8f * random.unit();
    }
    return items;
}

// The coordinates in which samples are uniform, from a point's coordinates along e1 and e2.
glm::dvec2 uniform_coordinates(const ExpectedLight& l, glm::dvec3 p) {
    const glm::dvec3 d(p - glm::dvec3(l.p)), e1(l.e1), e2(l.e2);
    const double det = e1.x * e2.y - e1.y * e2.x;
    const glm::dvec2 at((d.x * e2.y - d.y * e2.x) / det, (e1.x * d.y - e1.y * d.x) / det);
    const double sum = at.x + at.y;
    return l.triangle ? glm::dvec2(sum * sum, sum > 0.0 ? at.y / sum : 0.0) : at;
}

// The density is the probability of the light times the density of the point, converted to solid angle: pmf /
// area * distance^2 / cos.
bool is_right(const LightItem& item, const LightSample& s, size_t i, double total_power) {
    const ExpectedLight& l = LIGHTS[i];
    const glm::dvec3 to_light = point_of(item, s, i) - glm::dvec3(item.from);
    const double distance = length(to_light);
    const double cosine = -to_light.z / distance;  // All lights face +z.
    if (!(length(glm::dvec3(s.wi) - to_light / distance) <= 0x1p-20)) return false;
    if (s.Li != (cosine > 0.0 || l.two_sided ? l.radiance : vec3(0.0f))) return false;
    const double pdf = l.power() / total_power / l.area() * distance * distance / std::abs(cosine);
    // A cosine of 1e-2 has a relative error of 1e2 times 2^-22.
    const double relative = 4.0 + 2.0 / std::abs(cosine);
    if (!(std::abs(double(s.pdf) - pdf) <= pdf * 0x1p-22 * relative)) return false;
    // The shadow ray ends before the light: by at most eight roundings of the distance and sixteen
    // of the light's z, and a rounding of each.
    const double gap = std::copysign(1.0, cosine) * (item.from.z + s.shadow.z - l.p.z);
    if (!(gap > 0.0 && gap <= 0x1p-24 * (9.0 * distance + 17.0 * 4.0))) return false;
    // t_max is a millionth below 1, at most two.
    if (!(s.t_max < 1.0f && s.t_max >= 1.0f - 0x1p-19f)) return false;
    // A ray that hits the same light there agrees.
    if (s.light_met != i) return true;
    return s.Li_met == s.Li && std::abs(double(s.pdf_met) - double(s.pdf)) <= pdf * 0x1p-20 * relative;
}

}  // namespace

Scene scene_of_flat_lights() {
    Scene scene = scene_of_mesh({});
    scene.shapes.clear();
    for (const ExpectedLight& l : LIGHTS) {
        const Emission emission{.radiance = l.radiance, .two_sided = l.two_sided};
        if (l.triangle) {
            TriangleMesh triangle;
            add_triangle(triangle, l.p, l.p + l.e1, l.p + l.e2);
            add_shape(scene, std::move(triangle), 0, emission);
        } else {
            add_shape(scene, parallelogram(l.p, l.e1, l.e2), 0, emission);
        }
    }
    return scene;
}

Evidence test_flat_light_points(const vk::Device& device, Effort effort) {
    constexpr size_t CELLS = 8;
    Evidence evidence;
    std::vector<double> chosen(LIGHTS.size());
    std::vector<Histogram> points(LIGHTS.size(), Histogram(CELLS));
    const std::vector<LightItem> items = random_items(sized(effort, 200000));
    const std::vector<LightSample> samples =
        sample_lights(device, build_gpu_scene(scene_of_flat_lights(), SceneFrame{}), items);
    for (size_t k = 0; k < items.size(); ++k) {
        const size_t i = light_of(items[k], samples[k]);
        const glm::dvec2 at = i < LIGHTS.size()
                                  ? uniform_coordinates(LIGHTS[i], point_of(items[k], samples[k], i))
                                  : glm::dvec2(-1.0);
        const bool on_a_light = at.x > -1e-4 && at.x < 1.0001 && at.y > -1e-4 && at.y < 1.0001;
        evidence.expect(on_a_light, [&] { return concat("flat light ", i, ", at ", at.x, ' ', at.y); });
        if (!on_a_light) continue;
        ++chosen[i];
        points[i].add(at);
    }
    std::vector<double> powers;
    for (const ExpectedLight& l : LIGHTS)
        powers.push_back(l.power());
    evidence.add_p_value("choice among flat lights", pearson_p_value(chosen, powers));
    for (size_t i = 0; i < LIGHTS.size(); ++i)
        evidence.add_p_value(concat("points of flat light ", i), points[i].uniformity());
    return evidence;
}

Evidence test_flat_light_values(const vk::Device& device, SceneAccess access) {
    double total_power = 0.0;
    for (const ExpectedLight& l : LIGHTS)
        total_power += l.power();
    Evidence evidence;
    const std::vector<LightItem> items = random_items(20000);
    const std::vector<LightSample> samples =
        sample_lights(device, build_gpu_scene(scene_of_flat_lights(), SceneFrame{}), items, access);
    for (size_t k = 0; k < items.size(); ++k) {
        const LightSample& s = samples[k];
        const size_t i = light_of(items[k], s);
        evidence.expect(i < LIGHTS.size() && is_right(items[k], s, i, total_power), [&] {
            const vec3 from = items[k].from;
            return concat("flat light ", i, " from ", from.x, ' ', from.y, ' ', from.z, ": wi ", s.wi.x, ' ',
                          s.wi.y, ' ', s.wi.z, ", Li ", s.Li.x, ", pdf ", s.pdf, ", t_max ", s.t_max,
                          "; met: ", s.light_met, ", pdf ", s.pdf_met, ", Li ", s.Li_met.x);
        });
    }
    return evidence;
}

}  // namespace candela
