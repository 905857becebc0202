// Samples of spheres and disks that emit: over the solid angle of a sphere from outside, otherwise over the
// area.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "probe/scenes.h"
#include "selftest/charts.h"
#include "selftest/histogram.h"
#include "selftest/lights.h"
#include "shared/light.h"

namespace candela {
namespace {

constexpr size_t LIGHT_CELLS = 16;
constexpr uint32_t LIGHT_SAMPLES = 100000;
constexpr vec3 RADIANCE(3, 2, 1);

GpuScene scene_of(const decltype(Shape::geometry)& geometry, bool two_sided) {
    Scene scene = scene_of_mesh({});
    scene.shapes = {{.geometry = geometry,
                     .material = 0,
                     .emission = Emission{.radiance = RADIANCE, .two_sided = two_sided}}};
    return build_gpu_scene(scene, SceneFrame{});
}

std::string describe(const char* what, vec3 from, const LightSample& s) {
    return concat(what, " from ", from.x, ' ', from.y, ' ', from.z, ": wi ", s.wi.x, ' ', s.wi.y, ' ', s.wi.z,
                  ", pdf ", s.pdf, ", Li ", s.Li.x, ", occluded ", s.occluded, "; met: ", s.light_met,
                  ", pdf ", s.pdf_met, ", Li ", s.Li_met.x);
}

struct Place {
    Sphere sphere;
    vec3 from;
};

// From far away to almost touching; a tiny sphere and a huge one; away from the origin.
const std::vector<Place> OUTSIDE{
    {{dvec3(0, 0, -3), 1.0f}, vec3(0)},
    {{dvec3(1, 2, 3), 0.25f}, vec3(-1, 0.5f, 2)},
    {{dvec3(5, 4, 3), 1.0f}, vec3(300, 400, 500)},
    {{dvec3(0, 2, 0), 1e-3f}, vec3(0.5f, 0, 0)},
    {{dvec3(0), 1e-3f}, vec3(60, 0, 80)},
    {{dvec3(0, -1e4f, 0), 1e4f}, vec3(3, 1, 2)},
    {{dvec3(0, 0, -1), 1.0f}, vec3(0, 0, 0.01f)},
    {{dvec3(10, 0, 0), 2.0f}, vec3(7.999f, 0, 0)},
};

// Samples are uniform in 1 - cos of the angle to the axis and in the angle around it. The density has the
// error of 1 - cos(max) = sin^2 / (1 + sqrt(1 - sin^2)): sin^2 is off by 16 * 2^-24 of itself (the vector
// from the point to the centre enters twice), the root inherits this error over twice the root; the root
// itself, the inverse of an inverse root to Vulkan, is off by 9, and two divisions by 5 each: 16 more and
// some roundings. wi has the errors of the axis, an inverse root of 4 and some roundings, and of a direction
// around it, a root of 9 and sines of 4: 2^-19.
void test_sphere_from_outside(const vk::Device& device, const Place& place, uint32_t samples,
                              Evidence& evidence) {
    const Sphere& sphere = place.sphere;
    const vec3 from = place.from;
    const dvec3 to_center = dvec3(sphere.center) - dvec3(from);
    const double sine = double(sphere.radius) / length(to_center), root = std::sqrt(1.0 - sine * sine);
    const double h_max = sine * sine / (1.0 + root), pdf = 1.0 / (2.0 * M_PI * h_max);
    const dvec3 axis = normalize(to_center);
    const auto [x, y] = axes_around(axis);
    Histogram points(LIGHT_CELLS);
    size_t met = 0, outside = 0;
    for (const LightSample& s :
         sample_lights(device, scene_of(sphere, false), random_light_items(from, samples, 80))) {
        const dvec3 wi(s.wi), chord = wi - axis;
        const double h = 0.5 * dot(chord, chord);
        outside += h > h_max;
        points.add({h / h_max, turn_of(dot(wi, y), dot(wi, x))});
        bool right = std::abs(length(wi) - 1.0) <= 0x1p-19 &&
                     std::abs(double(s.pdf) - pdf) <= pdf * 0x1p-20 * (2.0 + 1.0 / root) &&
                     s.Li == RADIANCE && s.occluded == 0;
        if (s.light_met != NO_LIGHT) {
            ++met;
            right = right && std::abs(double(s.pdf_met) - double(s.pdf)) <= double(s.pdf) * 0x1p-22 &&
                    s.Li_met == RADIANCE;
        }
        evidence.expect(right, [&] { return describe("sphere", from, s); });
    }
    const std::string name = concat("sphere of radius ", sphere.radius, ' ', length(to_center), " m away");
    evidence.add_p_value(name, points.uniformity());
    // Rays past the limb: the distance of the centre has 4 roundings, relative to the radius.
    const double limb = std::min(1.0, 2.0 * 8 * 0x1p-24 / sine) * samples;
    evidence.expect(double(met) >= samples - 10.0 - 2.0 * limb && double(outside) <= 10.0 + 2.0 * limb, [&] {
        return concat(name, ": of ", samples, " samples ", met, " meet it, ", outside, " are beside it");
    });
}

}  // namespace

Evidence test_spheres_from_outside(const vk::Device& device, Effort effort) {
    Evidence evidence;
    for (const Place& place : OUTSIDE)
        test_sphere_from_outside(device, place, sized(effort, LIGHT_SAMPLES), evidence);
    return evidence;
}

// The point is uniform over the whole area; the density is that over the area, converted to solid angle. A
// sphere emits inwards only if it is two-sided.
Evidence test_spheres_from_inside(const vk::Device& device, Effort effort) {
    const Sphere sphere{dvec3(1, 2, 3), 2.0};
    Evidence evidence;
    for (const vec3 from : {vec3(1, 2, 3), vec3(2, 3, 3), vec3(1, 2, 4.99f)}) {
        Histogram points(LIGHT_CELLS);
        for (const LightSample& s :
             sample_lights(device, scene_of(sphere, true),
                           random_light_items(from, sized(effort, LIGHT_SAMPLES), 81))) {
            const dvec3 n = normalize(dvec3(from) + dvec3(s.shadow) - dvec3(sphere.center));
            const dvec3 to_light = dvec3(sphere.center) + 2.0 * n - dvec3(from);
            points.add({(n.z + 1.0) / 2.0, turn_of(n.y, n.x)});
            const double distance = length(to_light), cosine = dot(to_light, n) / distance;
            const double pdf = distance * distance / (16.0 * M_PI * cosine);
            // The error of using the shadow ray's end, about 10^-4 off the sphere, as the point.
            const double off = 1e-4 * (1.0 / distance + 1.0 / cosine);
            const bool right = length(dvec3(s.wi) - to_light / distance) <= 1e-4 / distance &&
                               std::abs(double(s.pdf) - pdf) <= pdf * 10.0 * off && s.Li == RADIANCE &&
                               s.occluded == 0 && s.light_met == 0 &&
                               std::abs(double(s.pdf_met) - double(s.pdf)) <= double(s.pdf) * off;
            evidence.expect(right, [&] { return describe("sphere around", from, s); });
        }
        evidence.add_p_value(concat("sphere from inside, z ", from.z), points.uniformity());
        for (const LightSample& s :
             sample_lights(device, scene_of(sphere, false), random_light_items(from, 1000, 82)))
            evidence.expect(s.Li == vec3(0.0f), [&] { return describe("one-sided sphere around", from, s); });
    }
    return evidence;
}

// An ellipse, in the coordinates of its axes; its front is where cross(e1, e2) points.
Evidence test_disks(const vk::Device& device, Effort effort) {
    const Disk disk{.center = dvec3(1, 2, 3), .e1 = dvec3(2, 0, 0), .e2 = dvec3(1, 3, 0)};
    Evidence evidence;
    for (const vec3 from : {vec3(0, 0, 5), vec3(1, 2, 3.5f), vec3(4, 0, -20)}) {
        Histogram points(LIGHT_CELLS);
        for (const LightSample& s : sample_lights(
                 device, scene_of(disk, false), random_light_items(from, sized(effort, LIGHT_SAMPLES), 83))) {
            const dvec3 p(dvec3(from) + dvec3(s.shadow));  // Offset only along z.
            const double y = (p.y - 2.0) / 3.0, x = (p.x - 1.0 - y) / 2.0;
            points.add({x * x + y * y, turn_of(y, x)});
            const dvec3 to_light = dvec3(p.x, p.y, 3.0) - dvec3(from);
            const double distance = length(to_light), cosine = std::abs(to_light.z) / distance;
            const double pdf = distance * distance / (6.0 * M_PI * cosine), relative = 4.0 + 2.0 / cosine;
            bool right = x * x + y * y <= 1.0 + 1e-5 &&
                         length(dvec3(s.wi) - to_light / distance) <= 0x1p-20 &&
                         std::abs(double(s.pdf) - pdf) <= pdf * 0x1p-22 * relative &&
                         s.Li == (from.z > 3.0f ? RADIANCE : vec3(0.0f)) && s.occluded == 0;
            if (s.light_met != NO_LIGHT)  // Otherwise it just misses the rim.
                right = right && std::abs(double(s.pdf_met) - double(s.pdf)) <= pdf * 0x1p-20 * relative;
            evidence.expect(right, [&] { return describe("disk", from, s); });
        }
        evidence.add_p_value(concat("disk from z ", from.z), points.uniformity());
    }
    return evidence;
}

}  // namespace candela
