// Traversal against brute force in bulk: random and aimed rays over five meshes, the worst of which has
// slivers, duplicated and overlapping triangles, and sizes from 1 mm to 1 km at once. Occlusion must agree as
// well.
#include <cmath>

#include "gpu/traversal_fixture.h"
#include "load/ply/ply.h"

namespace candela {
namespace {

// Rectangles parallel to the coordinate planes: flat boxes of the BVH.
TriangleMesh rectangles(uint32_t count) {
    Random random(200);
    TriangleMesh mesh;
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 p = random.cube();
        vec3 along(0.0f), across(0.0f);
        along[int(i % 3)] = 0.3f * random.unit();
        across[int((i + 1) % 3)] = 0.3f * random.unit();
        add_triangle(mesh, p, p + along, p + along + across);
        add_triangle(mesh, p, p + along + across, p + across);
    }
    return mesh;
}

struct NamedMesh {
    const char* name;
    TriangleMesh mesh;
    std::vector<float> reaches;  // Half the edges of the cubes around 0 that rays start from.
};

std::vector<NamedMesh> meshes() {
    std::vector<std::string> warnings;
    return {{"sphere", sphere_mesh(48, 64), {0.9f, 3.0f}},
            {"soup", triangle_soup(6000, 0.1f, 202), {1.5f}},
            {"rectangles", rectangles(3000), {1.0f, 1.5f}},
            {"knot",
             load_ply(CANDELA_SCENES "/knot.ply", MeshNormals::flat, FileReach(CANDELA_SCENES "/knot.ply"),
                      warnings),
             {3.0f, 10.0f}},
            {"nasty", nasty_mesh(8000), {1e-3f, 1e-1f, 1e1f, 1e3f}},
            {"a micrometre", in_its_frame(sphere_mesh(48, 64), 1e-6, dvec3(0)), {0.4f, 1.5f}},
            {"a thousand kilometres", in_its_frame(triangle_soup(6000, 0.1f, 203), 1e6, dvec3(0)), {0.7f}},
            {"far away", in_its_frame(rectangles(3000), 1.0, dvec3(1e7, -3e6, 0)), {0.5f, 0.7f}}};
}

class BruteForceTest : public TraversalTest {
  protected:
    // Compares that many tests of a ray against a triangle in total, the same number over each mesh; half of
    // the rays are random.
    void expect_brute_force_over_meshes(double tests, uint32_t seed) const {
        const std::vector<NamedMesh> all = meshes();
        for (const auto& [name, mesh, reaches] : all) {
            SCOPED_TRACE(name);
            const auto count = size_t(tests / double(all.size()) / double(mesh.triangles.size()) /
                                      double(reaches.size()) / 2.0) +
                               1;
            Rays rays;
            for (const float reach : reaches) {
                const Rays random = random_rays(count, vec3(0), reach, seed++);
                const Rays aimed = rays_at_features(mesh, count, vec3(0), reach, seed++);
                rays.insert(rays.end(), random.begin(), random.end());
                rays.insert(rays.end(), aimed.begin(), aimed.end());
            }
            const GpuScene scene = build_gpu_scene(scene_of_mesh(mesh), SceneFrame{});
            ASSERT_EQ(scene.id_count, mesh.triangles.size());
            const std::vector<TraversalResult> results = trace(scene, rays, SceneAccess::texel_buffers);
            expect_holds(compare_with_brute_force(results));
            EXPECT_GT(hits(results), rays.size() / 4);
            EXPECT_GE(double(rays.size()) * double(mesh.triangles.size()), tests / double(all.size()));
        }
    }
};

// Each takes about 10 ns of processor time on software Vulkan.
TEST_F(BruteForceTest, ABillionPairsOfRaysAndTriangles) {
    expect_brute_force_over_meshes(sized(test_effort(), 1'000'000'000), 210);
}

using SlowBruteForceTest = BruteForceTest;

TEST_F(SlowBruteForceTest, TenBillionPairsOfRaysAndTriangles) {
    expect_brute_force_over_meshes(1e10, 300);
}

}  // namespace
}  // namespace candela
