// What the tests of traversal share: rays must have the hits that testing every primitive finds.
#pragma once

#include <vector>

#include "gpu/device_fixture.h"
#include "probe/random.h"
#include "selftest/traversal.h"
#include "support/scene_builders.h"

namespace candela {

class TraversalTest : public DeviceTest {
  protected:
    std::vector<TraversalResult> trace(const GpuScene& scene, const Rays& rays, SceneAccess access) const {
        return candela::trace(device(), scene, rays, access);
    }

    // Traces the rays with either scene access and expects the hits of brute force. Returns the results.
    std::vector<TraversalResult> expect_brute_force(const Scene& scene, const Rays& rays) const {
        const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
        std::vector<TraversalResult> results;
        for (const SceneAccess access : {SceneAccess::storage_buffers, SceneAccess::texel_buffers}) {
            results = trace(gpu, rays, access);
            expect_holds(compare_with_brute_force(results));
        }
        return results;
    }
};

}  // namespace candela
