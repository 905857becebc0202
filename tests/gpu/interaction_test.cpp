// Rays that leave round shapes do not meet them again where they began, and rays that went into a sphere do
// not slip out.
#include <cmath>

#include "gpu/device_fixture.h"
#include "selftest/random.h"
#include "support/scene_builders.h"

namespace candela {
namespace {

constexpr float NO_HIT = 3.4028234e38f;  // FLOAT_MAX of base/math.glsl.

struct InteractionItem {
    vec3 o;
    float unused0 = 0.0f;
    vec3 d;
    float unused1 = 0.0f;
    vec3 wi;            // Turned over where it does not point to that side:
    uint32_t side = 0;  // 0: the viewer's, 1: the other.
};

struct InteractionResult {
    float t;
    vec3 p;
    float p_error;
    vec3 n;
    uint32_t front;
    vec3 next_o, next_d;
    float next_t;
    uint32_t id;
};

const std::vector<Sphere> SPHERES{
    {vec3(0), 1.0f},
    {vec3(0), 1e-3f},
    {vec3(0), 1e4f},
    {vec3(0, -1000, 0), 1000.0f},  // A ground whose top is at the origin.
    {vec3(0.3f, 0.6f, -0.2f), 0.5f},
    {vec3(1000, -2000, 3000), 1.0f},
    {vec3(100, 0, 100), 0.1f},
    {vec3(0, 0, 5), 1e-2f},
};

class InteractionTest : public DeviceTest {
  protected:
    static constexpr size_t COUNT = 20000;

    std::vector<InteractionResult> run(const decltype(Shape::geometry)& geometry,
                                       const std::vector<InteractionItem>& items) const {
        Scene scene = scene_of_mesh({});
        scene.shapes = {{.geometry = geometry, .material = 0, .emission = {}}};
        const DeviceScene on_device(device(), build_gpu_scene(scene), SceneAccess::texel_buffers);
        return map<InteractionResult>(kernels::interaction, items, {}, &on_device);
    }
    // Rays at points of the sphere, from around it (or from within); every second one leaves at a grazing
    // angle.
    static std::vector<InteractionItem> items(const Sphere& sphere, bool from_inside, uint32_t side,
                                              uint32_t seed) {
        Random random(seed);
        std::vector<InteractionItem> items(COUNT);
        for (size_t i = 0; i < COUNT; ++i) {
            const vec3 n = random.direction();
            const vec3 target = sphere.center + sphere.radius * n;
            const float away = from_inside ? 0.9f * random.unit() : 1.1f + 3.0f * random.unit();
            items[i].o = sphere.center + away * sphere.radius * random.direction();
            items[i].d = normalize(target - items[i].o);
            items[i].wi = random.direction();
            items[i].side = side;
        }
        return items;
    }
};

// The direction of the second ray lies in the hemisphere of the normal where it starts, down to grazing
// angles: the outside of a sphere cannot be seen from there.
TEST_F(InteractionTest, ARayFromOutsideASphereDoesNotMeetIt) {
    for (size_t k = 0; k < SPHERES.size(); ++k) {
        std::vector<InteractionItem> rays = items(SPHERES[k], false, 0, uint32_t(110 + k));
        std::vector<InteractionResult> results = run(SPHERES[k], rays);
        // Once more, at a grazing angle to the normals that were found.
        for (size_t i = 0; i < rays.size(); ++i) {
            const vec3 n = results[i].n, along = rays[i].wi - dot(rays[i].wi, n) * n;
            rays[i].wi = normalize(normalize(along) + 1e-4f * n);
        }
        const std::vector<InteractionResult> grazing = run(SPHERES[k], rays);
        results.insert(results.end(), grazing.begin(), grazing.end());
        size_t met = 0, again = 0;
        for (const InteractionResult& r : results) {
            if (r.t == NO_HIT) continue;
            ++met;
            ASSERT_EQ(r.front, 1u);
            again += r.next_t < NO_HIT;
        }
        EXPECT_GT(met, results.size() / 2);
        EXPECT_EQ(again, 0u) << "of " << met << ", sphere " << k;
    }
}

// Inside, after refraction or after reflection, the far side is met, never the near one: at a distance of 2 r
// cos, but for the offset of the origin, which at grazing angles is a larger part of it.
TEST_F(InteractionTest, ARayWithinASphereMeetsItsFarSide) {
    for (size_t k = 0; k < SPHERES.size(); ++k) {
        const Sphere& sphere = SPHERES[k];
        for (const bool from_inside : {false, true}) {
            const std::vector<InteractionItem> rays =
                items(sphere, from_inside, from_inside ? 0 : 1, uint32_t(130 + k));
            std::vector<InteractionItem> both = rays;
            const std::vector<InteractionResult> first = run(sphere, rays);
            for (size_t i = 0; i < rays.size(); ++i) {
                const vec3 n = from_inside ? first[i].n : -first[i].n;
                const vec3 along = rays[i].wi - dot(rays[i].wi, n) * n;
                both.push_back(rays[i]);
                both.back().wi = normalize(normalize(along) + 1e-3f * n);
            }
            size_t met = 0, escaped = 0;
            for (const InteractionResult& r : run(sphere, both)) {
                if (r.t == NO_HIT) continue;
                ++met;
                ASSERT_EQ(r.front, from_inside ? 0u : 1u);
                escaped += r.next_t == NO_HIT;
                if (r.next_t == NO_HIT) continue;
                const glm::dvec3 o(r.next_o), d(r.next_d), f = o - glm::dvec3(sphere.center);
                const double b = -dot(f, d), radius = double(sphere.radius);
                const double far = b + std::sqrt(std::max(0.0, b * b + radius * radius - dot(f, f)));
                ASSERT_NEAR(r.next_t, far, 1e-2 * radius + 4.0 * double(r.p_error)) << "sphere " << k;
            }
            EXPECT_GT(met, both.size() / 2);
            EXPECT_EQ(escaped, 0u) << "of " << met << ", sphere " << k << (from_inside ? ", inside" : "");
        }
    }
}

// The point is on the sphere within p_error, and the normal is that of the point.
TEST_F(InteractionTest, PointsLieOnTheSphere) {
    for (const Sphere& sphere : SPHERES) {
        for (const InteractionResult& r : run(sphere, items(sphere, false, 0, 150))) {
            if (r.t == NO_HIT) continue;
            const glm::dvec3 from_center = glm::dvec3(r.p) - glm::dvec3(sphere.center);
            ASSERT_LE(std::abs(length(from_center) - double(sphere.radius)), double(r.p_error));
            ASSERT_NEAR(length(glm::dvec3(r.n)), 1.0, 0x1p-20);
            ASSERT_LE(length(normalize(from_center) - glm::dvec3(r.n)),
                      2.0 * double(r.p_error / sphere.radius) + 0x1p-20);
            // The step off the surface is of the order of the error, or of what offset_origin takes.
            const glm::dvec3 step = glm::dvec3(r.next_o) - glm::dvec3(r.p);
            ASSERT_LE(length(step), 2.0 * double(r.p_error) + 0x1p-15 + 0x1p-14 * length(glm::dvec3(r.p)));
        }
    }
}

TEST_F(InteractionTest, ARayFromADiskDoesNotMeetIt) {
    for (const float radius : {1e-3f, 1.0f, 1e3f}) {
        for (const vec3 center : {vec3(0), vec3(0, -1, 0), vec3(100, 200, -300)}) {
            Random random(160);
            const vec3 e1 = radius * random.direction();
            const Disk disk{
                .center = center, .e1 = e1, .e2 = cross(e1, normalize(cross(e1, random.direction())))};
            std::vector<InteractionItem> rays;
            for (size_t i = 0; i < COUNT; ++i) {
                const vec3 target = center + 0.7f * random.unit() * disk.e1 + 0.7f * random.unit() * disk.e2;
                const vec3 o = center + 2.0f * radius * random.direction();
                rays.push_back({.o = o,
                                .d = normalize(target - o),
                                .wi = random.direction(),
                                .side = random.bits() % 2});
            }
            size_t met = 0, again = 0;
            for (const InteractionResult& r : run(disk, rays)) {
                if (r.t == NO_HIT) continue;
                ++met;
                again += r.next_t < NO_HIT;
            }
            EXPECT_GT(met, rays.size() * 9 / 10);
            EXPECT_EQ(again, 0u) << "of " << met << ", radius " << radius;
        }
    }
}

}  // namespace
}  // namespace candela
