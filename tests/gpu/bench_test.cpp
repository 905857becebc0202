// The benchmark's tracers do the work that they are timed for.
#include <algorithm>

#include "bench/meshes.h"
#include "bench/tracer.h"
#include "bench/triangles.h"
#include "gpu/device_fixture.h"
#include "selftest/traversal.h"

namespace candela {
namespace {

class BenchTest : public DeviceTest {
  protected:
    BenchTest()
        : scene_(displaced_scene(300)), gpu_(build_gpu_scene(scene_, SceneFrame{})), triangles_(gpu_) {}

    // The benchmark's own sets, of 256 camera rays and what follows from them, and rays from outside and
    // inside the room, many of which miss it.
    std::vector<RaySet> ray_sets() const {
        const auto tracer = make_device_tracer(device(), gpu_, SceneAccess::texel_buffers);
        std::vector<RaySet> sets = make_ray_sets(
            scene_, [&](uint32_t id) { return triangles_.at(id); }, triangles_.bounds(), 256,
            [&](const RaySet& set) { return run(*tracer, set); });
        RaySet closest{.name = "random rays", .rays = {}};
        for (const RayItem& ray : random_rays(256, vec3(0, 2, 0), 6.0f, 7))
            closest.rays.push_back({ray.o, INFINITE, ray.d});
        RaySet any = closest;
        any.any_hit = true;
        sets.push_back(closest);
        sets.push_back(any);
        return sets;
    }

    static std::vector<uint32_t> run(RayTracer& tracer, const RaySet& set) {
        tracer.prepare(set);
        tracer.trace(2);
        return tracer.results();
    }

    // The hits found by testing every triangle.
    std::vector<uint32_t> brute_force(const RaySet& set) const {
        Rays rays;
        for (const BenchRay& ray : set.rays)
            add(rays, ray.o, ray.d);
        std::vector<uint32_t> results;
        for (const TraversalResult& r : trace(device(), gpu_, rays, SceneAccess::texel_buffers)) {
            const bool hit = r.brute_t < set.rays[results.size()].t_max && r.brute_t < NO_HIT;
            results.push_back(!hit ? NO_TRIANGLE : set.any_hit ? ANY_HIT : r.brute_id);
        }
        return results;
    }

    Scene scene_;
    GpuScene gpu_;
    BenchTriangles triangles_;
};

TEST_F(BenchTest, KernelsFindTheHitsOfBruteForce) {
    for (const RaySet& set : ray_sets()) {
        const std::vector<uint32_t> expected = brute_force(set);
        const auto misses = std::ranges::count(expected, NO_TRIANGLE);
        EXPECT_LT(misses, ptrdiff_t(expected.size())) << set.name;
        // From the camera on, all rays stay in the closed room.
        const bool may_miss = set.any_hit || set.name == "random rays";
        EXPECT_EQ(misses > 0, may_miss) << set.name << ": " << misses;
        for (const SceneAccess access : {SceneAccess::texel_buffers, SceneAccess::storage_buffers}) {
            EXPECT_EQ(run(*make_device_tracer(device(), gpu_, access), set), expected) << set.name;
        }
    }
}

TEST_F(BenchTest, RaysInSeveralDispatchesFindTheSame) {
    const auto whole = make_device_tracer(device(), gpu_, SceneAccess::texel_buffers);
    // Neither a whole number of work groups nor a divisor of 256.
    const auto pieces = make_device_tracer(device(), gpu_, SceneAccess::texel_buffers, 100);
    for (const RaySet& set : ray_sets())
        EXPECT_EQ(run(*pieces, set), run(*whole, set)) << set.name;
}

// Without Embree there is nothing else to test.
TEST_F(BenchTest, TheRivalIsThereWhenItsVersionIsAndFindsTheSameHits) {
    const auto rival = make_embree_tracer(triangles_);
    ASSERT_EQ(rival != nullptr, embree_version().has_value());
    if (rival == nullptr) return;
    // No ray of this seed grazes an edge.
    for (const RaySet& set : ray_sets())
        EXPECT_EQ(run(*rival, set), brute_force(set)) << set.name;
}

}  // namespace
}  // namespace candela
