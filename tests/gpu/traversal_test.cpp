// Traversal of triangles against brute force on the device, with the renderer's own triangle test: exactly
// the same hit for random and adversarial rays; and against double precision on the CPU.
#include <cmath>

#include "gpu/traversal_fixture.h"

namespace candela {
namespace {

TEST_F(TraversalTest, CornellBox) {
    const std::vector<TraversalResult> results =
        expect_brute_force(cornell_box(), random_rays(10000, vec3(0.278f, 0.274f, 0.28f), 0.27f, 11));
    EXPECT_GT(hits(results), 8000u);
}

TEST_F(TraversalTest, TriangleSoup) {
    const TriangleMesh soup = triangle_soup(1000, 0.2f, 12);
    Rays rays = random_rays(samples(6000), vec3(0), 1.5f, 13);
    const Rays aimed = rays_at_features(soup, samples(4000), vec3(0), 1.5f, 14);
    rays.insert(rays.end(), aimed.begin(), aimed.end());
    EXPECT_GT(hits(expect_brute_force(scene_of_mesh(soup), rays)), rays.size() / 2);
}

TEST_F(TraversalTest, NothingEscapesFromAClosedMesh) {
    expect_holds(test_closed_meshes(device(), test_effort()));
}

// Needles a million times longer than wide.
TEST_F(TraversalTest, Slivers) {
    Random random(17);
    TriangleMesh mesh;
    for (uint32_t i = 0; i < 500; ++i) {
        const vec3 p = random.cube();
        const vec3 along = random.direction();
        mesh.positions.insert(mesh.positions.end(), {p, p + along, p + along + 1e-6f * random.direction()});
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const Rays rays = rays_at_features(mesh, samples(10000), vec3(0), 2.0f, 18);
    EXPECT_GT(hits(expect_brute_force(scene_of_mesh(mesh), rays)), rays.size() / 10);
}

TEST_F(TraversalTest, OfEqualTrianglesTheFirstInLeafOrderWins) {
    TriangleMesh mesh = triangle_soup(50, 0.5f, 19);
    const std::vector<uvec3> once = mesh.triangles;
    for (int copy = 0; copy < 9; ++copy)
        mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
    const Rays rays = rays_at_features(mesh, samples(10000), vec3(0), 1.5f, 20);
    EXPECT_GT(hits(expect_brute_force(scene_of_mesh(mesh), rays)), rays.size() / 2);
}

// A narrow V whose sides are one primitive: a ray from above hits one first, a ray from below the other.
TEST_F(TraversalTest, OfTwoTrianglesWithACommonEdgeTheNearerOneIsHit) {
    const TriangleMesh mesh{
        .positions = {vec3(0, 0, 0), vec3(1, 0.1f, 0.5f), vec3(0, 0, 1), vec3(1, -0.1f, 0.5f)},
        .normals = {},
        .triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)}};
    ASSERT_EQ(build_gpu_scene(scene_of_mesh(mesh), SceneFrame{}).primitive_count, 1u);
    Rays rays;
    add(rays, vec3(0.5f, 5, 0.5f), vec3(0, -1, 0));
    add(rays, vec3(0.5f, -5, 0.5f), vec3(0, 1, 0));
    const std::vector<TraversalResult> results = expect_brute_force(scene_of_mesh(mesh), rays);
    for (const uint32_t i : {0u, 1u}) {
        EXPECT_EQ(results[i].id, i);
        EXPECT_NEAR(results[i].t, 4.95f, 1e-5f);
    }
}

// Triangles from 1 mm to 1 km in one scene.
TEST_F(TraversalTest, AMillionfoldRatioOfSizes) {
    Random random(21);
    TriangleMesh mesh;
    for (uint32_t i = 0; i < 600; ++i) {
        const float size = std::pow(10.0f, -3.0f + 6.0f * float(i) / 600.0f);
        const vec3 centre = size * random.cube();
        for (int corner = 0; corner < 3; ++corner)
            mesh.positions.push_back(centre + size * random.cube());
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    Rays rays;
    for (const float scale : {1e-3f, 1e-1f, 1e1f, 1e3f}) {
        const Rays random_ones = random_rays(samples(1250), vec3(0), scale, 22);
        const Rays aimed = rays_at_features(mesh, samples(1250), vec3(0), scale, 23);
        rays.insert(rays.end(), random_ones.begin(), random_ones.end());
        rays.insert(rays.end(), aimed.begin(), aimed.end());
    }
    EXPECT_GT(hits(expect_brute_force(scene_of_mesh(mesh), rays)), rays.size() * 8 / 10);
}

// A grid of axis-parallel squares: rays along the axes that start in faces of boxes, run within planes and
// through edges and corners; components of 0 with either sign.
TEST_F(TraversalTest, AxisParallelRaysFromFacesOfBoxes) {
    Scene scene = scene_of_mesh({});
    scene.shapes.clear();
    for (int i = -2; i < 2; ++i) {
        for (int k = -2; k < 2; ++k) {
            for (int plane = -2; plane <= 2; ++plane) {
                const float a = 0.5f * float(i), b = 0.5f * float(k), c = 0.5f * float(plane);
                scene.shapes.push_back(
                    {.geometry = parallelogram(vec3(a, b, c), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0)),
                     .emission = {}});
                scene.shapes.push_back(
                    {.geometry = parallelogram(vec3(c, a, b), vec3(0, 0.5f, 0), vec3(0, 0, 0.5f)),
                     .emission = {}});
            }
        }
    }
    Rays rays;
    for (int x = -5; x <= 5; ++x) {
        for (int y = -5; y <= 5; ++y) {
            for (int z = -5; z <= 5; ++z) {
                for (const int axis : {0, 1, 2}) {
                    for (const float sign : {-1.0f, 1.0f}) {
                        vec3 d(-0.0f, 0.0f, -0.0f);
                        d[axis] = sign;
                        add(rays, 0.25f * vec3(float(x), float(y), float(z)), d);
                    }
                }
            }
        }
    }
    EXPECT_GT(hits(expect_brute_force(scene, rays)), rays.size() / 4);
}

TEST_F(TraversalTest, AnEmptySceneHasNoHits) {
    EXPECT_EQ(hits(expect_brute_force(scene_of_mesh({}), random_rays(1000, vec3(0), 1.0f, 24))), 0u);
}

TEST_F(TraversalTest, OneTriangle) {
    const TriangleMesh triangle{.positions = {vec3(-1, -1, -2), vec3(1, -1, -2), vec3(0, 1, -2)},
                                .normals = {},
                                .triangles = {uvec3(0, 1, 2)}};
    Rays rays = random_rays(1000, vec3(0), 2.0f, 25);
    add(rays, vec3(0), vec3(0, 0, -1));        // The centre of the front.
    add(rays, vec3(0), vec3(0, 0, 1));         // Away from it.
    add(rays, vec3(0, 0, -4), vec3(0, 0, 1));  // From behind.
    const std::vector<TraversalResult> results = expect_brute_force(scene_of_mesh(triangle), rays);
    EXPECT_EQ(results[1000].t, 2.0f);
    EXPECT_EQ(results[1000].b, vec2(0.25f, 0.5f));
    EXPECT_EQ(results[1001].t, NO_HIT);
    EXPECT_EQ(results[1002].t, 2.0f);
}

// What double precision says of the ray and a triangle that it hits, and how far floats may be off.
struct ExpectedHit {
    double t;
    double bound;
    bool well_conditioned;
};

// The error bound of triangles_intersect. In units of 2^-24, with P the largest component of a vertex seen
// from the origin and D the triangle's extent across the ray: a division is off by 5 (2.5 ulp), so a sheared
// coordinate by 10 P, an edge function by 48 P D, the determinant `det` (twice the area across the ray) by
// three times that, a barycentric coordinate by 192 P D / det. Their errors act on the range `depth` of the
// vertices along the ray; the remaining operations are off by 20 P in sum. The bound doubles nearly all that,
// for second-order terms, which are small if the barycentric coordinates are good to 1/4.
ExpectedHit in_double(const RayItem& ray, const TriangleMesh& mesh, uint32_t id) {
    int kz = 0;
    for (const int axis : {1, 2})
        kz = std::abs(ray.d[axis]) > std::abs(ray.d[kz]) ? axis : kz;
    const int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    std::array<glm::dvec3, 3> v;  // Seen from the origin, sheared; z in lengths of d.
    double farthest = 0.0;
    for (const int i : {0, 1, 2}) {
        const glm::dvec3 p(glm::dvec3(mesh.positions[mesh.triangles[id][i]]) - glm::dvec3(ray.o));
        const double z = p[kz] / double(ray.d[kz]);
        v[size_t(i)] = glm::dvec3(p[kx] - z * ray.d[kx], p[ky] - z * ray.d[ky], z);
        farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    const auto area = [](glm::dvec3 a, glm::dvec3 b) { return a.x * b.y - a.y * b.x; };
    const double u = area(v[1], v[2]), w = area(v[0], v[1]), det = u + area(v[2], v[0]) + w;
    const double t = (u * v[0].z + area(v[2], v[0]) * v[1].z + w * v[2].z) / det;
    double extent = 0.0, depth = 0.0;
    for (const size_t i : {0u, 1u, 2u}) {
        const glm::dvec3 edge(v[i] - v[(i + 1) % 3]);
        extent = std::max(extent, std::hypot(edge.x, edge.y));
        depth = std::max(depth, std::abs(edge.z));
    }
    const double unit = 0x1p-24 * farthest / std::abs(double(ray.d[kz]));
    const double condition = 1024.0 * extent / std::abs(det);
    return {t, unit * 32.0 + 0x1p-24 * farthest * condition * depth, 0x1p-24 * farthest * condition < 0.25};
}

TEST_F(TraversalTest, DistancesAgreeWithDoublePrecision) {
    const auto check = [&](const TriangleMesh& mesh, const Rays& rays, double required_fraction) {
        const GpuScene gpu = build_gpu_scene(scene_of_mesh(mesh), SceneFrame{});
        const std::vector<TraversalResult> results = trace(gpu, rays, SceneAccess::texel_buffers);
        size_t checked = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (results[i].t == NO_HIT) continue;
            const ExpectedHit expected = in_double(rays[i], mesh, results[i].id);
            if (!expected.well_conditioned) continue;
            ++checked;
            ASSERT_NEAR(results[i].t, expected.t, expected.bound) << i;
        }
        EXPECT_GT(double(checked), required_fraction * double(rays.size()));
    };
    check(sphere_mesh(32, 32), random_rays(samples(10000), vec3(0), 0.5f, 26), 0.99);
    const TriangleMesh soup = triangle_soup(1000, 0.2f, 27);
    check(soup, rays_at_features(soup, samples(10000), vec3(0), 1.5f, 28), 0.7);
}

// Independent of everything on the device: the nearest hit by Moeller and Trumbore's test in double
// precision. From inside a convex mesh there is exactly one.
TEST_F(TraversalTest, TheNearestHitIsTheOneOfDoublePrecision) {
    const TriangleMesh mesh = sphere_mesh(16, 16);
    const Rays rays = random_rays(2000, vec3(0), 0.5f, 29);
    const std::vector<TraversalResult> results =
        trace(build_gpu_scene(scene_of_mesh(mesh), SceneFrame{}), rays, SceneAccess::texel_buffers);
    for (size_t i = 0; i < rays.size(); ++i) {
        const glm::dvec3 o(rays[i].o), d(rays[i].d);
        double nearest = INFINITE;
        for (const uvec3 t : mesh.triangles) {
            const glm::dvec3 v0(mesh.positions[t.x]);
            const glm::dvec3 e1(glm::dvec3(mesh.positions[t.y]) - v0),
                e2(glm::dvec3(mesh.positions[t.z]) - v0);
            const double det = dot(cross(d, e2), e1);
            const double u = dot(cross(d, e2), o - v0) / det, v = dot(cross(o - v0, e1), d) / det;
            const double distance = dot(cross(o - v0, e1), e2) / det;
            if (std::min({u, v, 1.0 - u - v}) >= -1e-12 && distance > 0.0)
                nearest = std::min(nearest, distance);
        }
        const ExpectedHit expected = in_double(rays[i], mesh, results[i].id);
        ASSERT_NEAR(results[i].t, nearest, expected.bound) << i;
    }
}

}  // namespace
}  // namespace candela
