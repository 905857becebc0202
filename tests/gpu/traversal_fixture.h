// What the tests of traversal share: the hits of rays must be those of looking at every primitive.
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

    // Traces the rays both ways of access and demands the hits of brute force. Returns the results.
    std::vector<TraversalResult> expect_brute_force(const Scene& scene, const Rays& rays) const {
        const GpuScene gpu = build_gpu_scene(scene);
        std::vector<TraversalResult> results;
        for (const SceneAccess access : {SceneAccess::storage_buffers, SceneAccess::texel_buffers}) {
            results = trace(gpu, rays, access);
            expect_holds(compare_with_brute_force(results));
        }
        return results;
    }
};

}  // namespace candela
