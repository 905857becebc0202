// See spheres.h.
#include "selftest/spheres.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/text.h"
#include "probe/probe.h"
#include "probe/probes.h"
#include "probe/random.h"
#include "probe/scenes.h"
#include "selftest/traversal.h"

namespace candela {
namespace {

constexpr uint32_t COUNT = 20000;

const std::vector<Sphere> SPHERES{
    {dvec3(0), 1.0f},
    {dvec3(0), 1e-3f},
    {dvec3(0), 1e4f},
    {dvec3(0, -1000, 0), 1000.0f},  // A ground whose top is at the origin.
    {dvec3(0.3f, 0.6f, -0.2f), 0.5f},
    {dvec3(1000, -2000, 3000), 1.0f},
    {dvec3(100, 0, 100), 0.1f},
    {dvec3(0, 0, 5), 1e-2f},
};

// Runs shaders/probes/interaction. One kernel for all scenes: it takes longer to compile than to run.
class Interactions {
  public:
    explicit Interactions(const vk::Device& device) : device_(device) {}

    std::vector<InteractionResult> operator()(const decltype(Shape::geometry)& geometry,
                                              const std::vector<InteractionItem>& items) {
        Scene scene = scene_of_mesh({});
        scene.shapes = {{.geometry = geometry, .material = 0, .emission = {}}};
        const DeviceScene on_device(device_, build_gpu_scene(scene, SceneFrame{}),
                                    SceneAccess::texel_buffers);
        if (!kernel_) kernel_ = make_probe(device_, kernels::interaction, {}, &on_device, "interaction");
        return probe<InteractionResult>(device_, *kernel_, items, &on_device);
    }

  private:
    const vk::Device& device_;
    std::optional<vk::Kernel> kernel_;
};

// Rays towards points of the sphere, from outside or from inside.
std::vector<InteractionItem> items(Effort effort, const Sphere& sphere, bool from_inside, uint32_t side,
                                   uint32_t seed) {
    Random random(seed);
    std::vector<InteractionItem> items(sized(effort, COUNT));
    for (InteractionItem& item : items) {
        const vec3 n = random.direction();
        const vec3 center(sphere.center);
        const auto radius = float(sphere.radius);
        const vec3 target = center + radius * n;
        const float away = from_inside ? 0.9f * random.unit() : 1.1f + 3.0f * random.unit();
        item.o = center + away * radius * random.direction();
        item.d = normalize(target - item.o);
        item.wi = random.direction();
        item.side = side;
    }
    return items;
}

// wi, turned to a grazing angle with n, with that cosine.
vec3 grazing(vec3 wi, vec3 n, float cosine) {
    return normalize(normalize(wi - dot(wi, n) * n) + cosine * n);
}

std::string name_of(const Sphere& sphere) {
    return concat("sphere of radius ", sphere.radius, " at ", sphere.center.x, ' ', sphere.center.y, ' ',
                  sphere.center.z);
}

// More than this fraction of the rays must have hit the shape; otherwise the test would prove nothing.
void expect_most_meet(const std::string& name, size_t met, double fraction, size_t rays, Evidence& evidence) {
    evidence.expect(double(met) > fraction * double(rays),
                    [&] { return concat(name, ": only ", met, " of ", rays, " rays meet it"); });
}

// Whether the second ray of `r` hits the far side of the sphere. The expected distance is computed from the
// ray's own origin, whose offset matters at grazing angles.
bool meets_far_side(const Sphere& sphere, const InteractionResult& r) {
    if (r.next_t == NO_HIT) return false;
    const glm::dvec3 o(r.next_o), d(r.next_d), f = o - glm::dvec3(sphere.center);
    const double b = -dot(f, d), radius = double(sphere.radius);
    const double far = b + std::sqrt(std::max(0.0, b * b + radius * radius - dot(f, f)));
    return std::abs(double(r.next_t) - far) <= 1e-2 * radius + 4.0 * double(r.p_error);
}

void test_rays_within(Interactions& run, Effort effort, const Sphere& sphere, bool from_inside, uint32_t seed,
                      Evidence& evidence) {
    const std::string name = name_of(sphere) + (from_inside ? ", from inside" : "");
    const std::vector<InteractionItem> rays = items(effort, sphere, from_inside, from_inside ? 0 : 1, seed);
    std::vector<InteractionItem> both = rays;
    const std::vector<InteractionResult> first = run(sphere, rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        both.push_back(rays[i]);
        both.back().wi = grazing(rays[i].wi, from_inside ? first[i].n : -first[i].n, 1e-3f);
    }
    size_t met = 0;
    for (const InteractionResult& r : run(sphere, both)) {
        if (r.t == NO_HIT) continue;
        ++met;
        evidence.expect(r.front == (from_inside ? 0u : 1u) && meets_far_side(sphere, r), [&] {
            return concat(name, ": from ", r.next_o.x, ' ', r.next_o.y, ' ', r.next_o.z, " towards ",
                          r.next_d.x, ' ', r.next_d.y, ' ', r.next_d.z, ": t ", r.next_t, ", front ",
                          r.front);
        });
    }
    expect_most_meet(name, met, 0.5, both.size(), evidence);
}

}  // namespace

// The second ray points into the hemisphere of the normal where it starts, down to grazing angles: in these
// directions, it cannot hit the outside of the sphere.
Evidence test_rays_outside_spheres(const vk::Device& device, Effort effort) {
    Interactions run(device);
    Evidence evidence;
    uint32_t seed = 110;
    for (const Sphere& sphere : SPHERES) {
        std::vector<InteractionItem> rays = items(effort, sphere, false, 0, seed++);
        std::vector<InteractionResult> results = run(sphere, rays);
        // Again, at a grazing angle to the normals found.
        for (size_t i = 0; i < rays.size(); ++i)
            rays[i].wi = grazing(rays[i].wi, results[i].n, 1e-4f);
        const std::vector<InteractionResult> more = run(sphere, rays);
        results.insert(results.end(), more.begin(), more.end());
        size_t met = 0;
        for (const InteractionResult& r : results) {
            if (r.t == NO_HIT) continue;
            ++met;
            evidence.expect(r.front == 1 && r.next_t == NO_HIT, [&] {
                return concat(name_of(sphere), ": met again after ", r.next_t, " from ", r.next_o.x, ' ',
                              r.next_o.y, ' ', r.next_o.z, ", front ", r.front);
            });
        }
        expect_most_meet(name_of(sphere), met, 0.5, results.size(), evidence);
    }
    return evidence;
}

Evidence test_rays_within_spheres(const vk::Device& device, Effort effort) {
    Interactions run(device);
    Evidence evidence;
    uint32_t seed = 130;
    for (const Sphere& sphere : SPHERES) {
        for (const bool from_inside : {false, true})
            test_rays_within(run, effort, sphere, from_inside, seed, evidence);
        ++seed;
    }
    return evidence;
}

Evidence test_points_on_spheres(const vk::Device& device, Effort effort) {
    Interactions run(device);
    Evidence evidence;
    for (const Sphere& sphere : SPHERES) {
        for (const InteractionResult& r : run(sphere, items(effort, sphere, false, 0, 150))) {
            if (r.t == NO_HIT) continue;
            const glm::dvec3 p(r.p), n(r.n), from_center = p - glm::dvec3(sphere.center);
            const double error = double(r.p_error);
            const double step = length(glm::dvec3(r.next_o) - p);
            const bool right =
                std::abs(length(from_center) - double(sphere.radius)) <= error &&
                std::abs(length(n) - 1.0) <= 0x1p-20 &&
                length(normalize(from_center) - n) <= 2.0 * double(r.p_error / sphere.radius) + 0x1p-20 &&
                step <= error + 0x1p-23 * length(p);
            evidence.expect(right, [&] {
                return concat(name_of(sphere), ": point ", r.p.x, ' ', r.p.y, ' ', r.p.z, ", error ",
                              r.p_error, ", normal ", r.n.x, ' ', r.n.y, ' ', r.n.z, ", step ", step);
            });
        }
    }
    return evidence;
}

Evidence test_rays_at_disks(const vk::Device& device, Effort effort) {
    Interactions run(device);
    Evidence evidence;
    for (const float radius : {1e-3f, 1.0f, 1e3f}) {
        for (const vec3 center : {vec3(0), vec3(0, -1, 0), vec3(100, 200, -300)}) {
            Random random(160);
            const vec3 e1 = radius * random.direction();
            const vec3 e2 = cross(e1, normalize(cross(e1, random.direction())));
            const Disk disk{.center = dvec3(center), .e1 = dvec3(e1), .e2 = dvec3(e2)};
            std::vector<InteractionItem> rays;
            for (size_t i = 0; i < sized(effort, COUNT); ++i) {
                const vec2 place = 0.7f * random.square();
                const vec3 target = center + place.x * e1 + place.y * e2;
                const vec3 o = center + 2.0f * radius * random.direction();
                rays.push_back({.o = o,
                                .d = normalize(target - o),
                                .wi = random.direction(),
                                .side = random.bits() % 2});
            }
            const std::string name = concat("disk of radius ", radius, " at ", center.x);
            size_t met = 0;
            for (const InteractionResult& r : run(disk, rays)) {
                if (r.t == NO_HIT) continue;
                ++met;
                evidence.expect(r.next_t == NO_HIT,
                                [&] { return concat(name, ": met again after ", r.next_t); });
            }
            expect_most_meet(name, met, 0.9, rays.size(), evidence);
        }
    }
    return evidence;
}

}  // namespace candela
