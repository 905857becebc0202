// Rays against spheres and disks: the BVH against brute force on the device, and against double precision on
// the CPU.
#include <cmath>

#include "gpu/traversal_fixture.h"

namespace candela {
namespace {

struct RoundScene {
    Scene scene;
    std::vector<Sphere> spheres;  // The first primitives.
    std::vector<Disk> disks;      // The next primitives; a soup of triangles follows.
};

// Spheres and disks from 1 mm to 1 m in [-1, 1]^3, among triangles.
RoundScene round_scene(uint32_t count, uint32_t seed) {
    Random random(seed);
    RoundScene round{scene_of_mesh({}), {}, {}};
    round.scene.shapes.clear();
    const auto size = [&] { return std::pow(10.0f, -3.0f + 2.5f * random.unit()); };
    for (uint32_t i = 0; i < count; ++i) {
        round.spheres.push_back({.center = dvec3(random.cube()), .radius = size()});
        round.scene.shapes.push_back({.geometry = round.spheres.back(), .material = 0, .emission = {}});
    }
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 e1 = size() * random.direction();
        const vec3 e2 = i % 4 == 0 ? size() * random.direction()  // An ellipse; or else a disk.
                                   : cross(e1, normalize(cross(e1, random.direction())));
        round.disks.push_back({.center = dvec3(random.cube()), .e1 = dvec3(e1), .e2 = dvec3(e2)});
        round.scene.shapes.push_back({.geometry = round.disks.back(), .material = 0, .emission = {}});
    }
    add_shape(round.scene, triangle_soup(count, 0.1f, seed), 0);
    return round;
}

// From random points towards random points of the shapes.
Rays rays_at_shapes(const RoundScene& round, size_t count, float size, uint32_t seed) {
    Random random(seed);
    Rays rays;
    while (rays.size() < count) {
        const vec3 o = size * random.cube();
        const Sphere& s = round.spheres[random.bits() % round.spheres.size()];
        add(rays, o, normalize(vec3(s.center) + float(s.radius) * random.cube() - o));
        const Disk& d = round.disks[random.bits() % round.disks.size()];
        const vec3 at = random.cube();
        add(rays, o, vec3(d.center) + at.x * vec3(d.e1) + at.y * vec3(d.e2) - o);  // Not of unit length.
    }
    return rays;
}

using RoundShapesTest = TraversalTest;

TEST_F(RoundShapesTest, TheBvhFindsTheHitsOfBruteForce) {
    const RoundScene round = round_scene(300, 100);
    Rays rays = random_rays(4000, vec3(0), 1.5f, 101);
    for (const float size : {0.5f, 2.0f, 50.0f}) {
        const Rays aimed = rays_at_shapes(round, 4000, size, 102);
        rays.insert(rays.end(), aimed.begin(), aimed.end());
    }
    EXPECT_GT(hits(expect_brute_force(round.scene, rays)), rays.size() / 2);
}

TEST_F(RoundShapesTest, OfEqualOnesTheFirstInLeafOrderWins) {
    RoundScene round = round_scene(40, 103);
    const std::vector<Shape> once = round.scene.shapes;
    for (int copy = 0; copy < 5; ++copy)
        round.scene.shapes.insert(round.scene.shapes.end(), once.begin(), once.end());
    EXPECT_GT(hits(expect_brute_force(round.scene, rays_at_shapes(round, 4000, 2.0f, 104))), 1000u);
}

// The nearest t > 0 in double precision, and a bound on the error of floats; none for a miss, or where
// rounding decides whether there is a hit.
struct ExpectedDistance {
    double t;
    double bound;
};

// Lengths are relative to d. The point of the line next to the centre is off by e = 8 * 2^-24 of the centre's
// distance D; the half chord, sqrt(r^2 - near^2), by (2 r e) / (2 half), and t by that and the roundings of
// D.
std::optional<ExpectedDistance> expected(const Sphere& sphere, const RayItem& ray) {
    const glm::dvec3 d(ray.d), f = glm::dvec3(ray.o) - glm::dvec3(sphere.center);
    const double a = length(d), b = -dot(f, d) / a, D = length(f), r = sphere.radius;
    const double near = length(f + b / a * d), e = 8 * 0x1p-24 * (D + r);
    if (near > r - 4.0 * e) return std::nullopt;
    const double half = std::sqrt(r * r - near * near);
    const double t = b - half > 0.0 ? b - half : b + half;
    if (t <= 0.0) return std::nullopt;
    return ExpectedDistance{t / a, (e + r * e / half + 4 * 0x1p-24 * t) / a};
}

// The plane's distance has the roundings of a product of D, over the cosine; twice, for those of the normal.
std::optional<ExpectedDistance> expected(const Disk& disk, const RayItem& ray) {
    const glm::dvec3 d(ray.d), e1(disk.e1), e2(disk.e2), n = normalize(cross(e1, e2));
    const glm::dvec3 to_center = glm::dvec3(disk.center) - glm::dvec3(ray.o);
    const double cosine = dot(d, n) / length(d), t = dot(to_center, n) / dot(d, n);
    const glm::dvec3 p = t * d - to_center;
    const double area = dot(cross(e1, e2), n);
    const double x = dot(cross(p, e2), n) / area, y = dot(cross(e1, p), n) / area;
    if (std::abs(cosine) < 1e-2 || x * x + y * y > 0.98 || t <= 0.0) return std::nullopt;
    return ExpectedDistance{t, 24 * 0x1p-24 * length(to_center) / std::abs(cosine) / length(d)};
}

TEST_F(RoundShapesTest, DistancesAgreeWithDoublePrecision) {
    Random random(105);
    for (const float distance : {0.5f, 2.0f, 100.0f}) {
        for (int i = 0; i < 8; ++i) {
            const Sphere sphere{.center = dvec3(random.cube()), .radius = 0.01f + random.unit()};
            const vec3 e1 = random.direction();
            const Disk disk{.center = dvec3(random.cube()),
                            .e1 = dvec3(e1),
                            .e2 = dvec3(0.5f * normalize(cross(e1, random.direction())))};
            Scene ball = scene_of_mesh({}), plate = ball;
            ball.shapes = {{.geometry = sphere, .material = 0, .emission = {}}};
            plate.shapes = {{.geometry = disk, .material = 0, .emission = {}}};
            Rays rays;
            for (int k = 0; k < 2000; ++k) {
                const vec3 o = distance * random.cube();
                add(rays, o, normalize(random.cube() - o));
                add(rays, o, vec3(sphere.center) + float(sphere.radius) * random.cube() - o);
                const vec2 place = random.square();
                add(rays, o, vec3(disk.center) + vec3(disk.e1) * place.x + vec3(disk.e2) * place.y - o);
            }
            const auto check = [&](const Scene& scene, const auto& shape) {
                size_t checked = 0;
                const auto results =
                    trace(build_gpu_scene(scene, SceneFrame{}), rays, SceneAccess::texel_buffers);
                for (size_t k = 0; k < rays.size(); ++k) {
                    const std::optional<ExpectedDistance> e = expected(shape, rays[k]);
                    if (!e) continue;
                    ++checked;
                    ASSERT_NEAR(results[k].t, e->t, e->bound) << k;
                }
                EXPECT_GT(checked, rays.size() / 20);
            };
            check(ball, sphere);
            check(plate, disk);
        }
    }
}

// Surface coordinates of a disk, and rays that miss: beside it, behind it, within its plane.
TEST_F(RoundShapesTest, ADiskIsMetWithinItsRimOnly) {
    Scene scene = scene_of_mesh({});
    scene.shapes = {{.geometry = Disk{.center = dvec3(1, 2, 0), .e1 = dvec3(2, 0, 0), .e2 = dvec3(0, 1, 0)},
                     .material = 0,
                     .emission = {}}};
    Rays rays;
    add(rays, vec3(2, 2.5f, 3), vec3(0, 0, -1));
    add(rays, vec3(2.99f, 2, -3), vec3(0, 0, 2));  // From behind.
    add(rays, vec3(3.01f, 2, 3), vec3(0, 0, -1));
    add(rays, vec3(1, 3.01f, 3), vec3(0, 0, -1));
    add(rays, vec3(2, 2.5f, 3), vec3(0, 0, 1));
    add(rays, vec3(-5, 2, 0), vec3(1, 0, 0));
    add(rays, vec3(-5, 2, 1), vec3(1, 0, 0));
    const std::vector<TraversalResult> results = expect_brute_force(scene, rays);
    EXPECT_EQ(results[0].t, 3.0f);
    EXPECT_EQ(results[0].b, vec2(0.5f, 0.5f));
    EXPECT_EQ(results[1].t, 1.5f);
    EXPECT_NEAR(results[1].b.x, 0.995f, 1e-6f);
    for (size_t i = 2; i < rays.size(); ++i)
        EXPECT_EQ(results[i].t, NO_HIT) << i;
}

}  // namespace
}  // namespace candela
