// What the tests of traversal share: rays, and their hits by the BVH and by looking at every primitive.
#pragma once

#include <algorithm>
#include <vector>

#include "gpu/device_fixture.h"
#include "selftest/random.h"
#include "support/scene_builders.h"

namespace candela {

inline constexpr float NO_HIT = 3.4028234e38f;  // FLOAT_MAX of base/math.glsl.

using Rays = std::vector<RayItem>;

inline void add(Rays& rays, vec3 o, vec3 d) {
    rays.push_back({o, 0.0f, d, 0.0f});
}

// From random points of a cube around `centre` of edge 2 `size`, in random directions.
inline Rays random_rays(size_t count, vec3 centre, float size, uint32_t seed) {
    Random random(seed);
    Rays rays;
    while (rays.size() < count) {
        const vec3 o = centre + size * random.cube();
        add(rays, o, random.direction());
    }
    return rays;
}

class TraversalTest : public DeviceTest {
  protected:
    std::vector<TraversalResult> trace(const GpuScene& scene, const Rays& rays, SceneAccess access) const {
        const DeviceScene on_device(device(), scene, access);
        return map<TraversalResult>(
            access == SceneAccess::texel_buffers ? kernels::traversal : kernels::traversal_storage, rays, {},
            &on_device);
    }

    // Traces the rays both ways of access and demands the hits of brute force. Returns the results.
    std::vector<TraversalResult> expect_brute_force(const Scene& scene, const Rays& rays) const {
        const GpuScene gpu = build_gpu_scene(scene);
        std::vector<TraversalResult> results;
        for (const SceneAccess access : {SceneAccess::storage_buffers, SceneAccess::texel_buffers}) {
            results = trace(gpu, rays, access);
            for (size_t i = 0; i < rays.size() && !HasFailure(); ++i) {
                const TraversalResult& r = results[i];
                const uint32_t hit = r.t < NO_HIT;
                EXPECT_TRUE(r.t == r.brute_t && r.id == r.brute_id && r.occluded_before == 0 &&
                            r.occluded_at == hit && r.occluded == hit)
                    << "ray " << i << ": t " << r.t << ", primitive " << r.id
                    << "; brute force: " << r.brute_t << ", " << r.brute_id
                    << "; occluded before, at, anywhere: " << r.occluded_before << r.occluded_at
                    << r.occluded;
            }
        }
        return results;
    }
};

inline size_t hits(const std::vector<TraversalResult>& results) {
    return size_t(std::count_if(results.begin(), results.end(), [](const auto& r) { return r.t < NO_HIT; }));
}

}  // namespace candela
