// What the tests of lights share: light samples on the device, by the kernel light_sample.comp.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/statistics.h"
#include "gpu/device_fixture.h"
#include "selftest/random.h"
#include "support/scene_builders.h"

namespace candela {

class LightTest : public DeviceTest {
  protected:
    std::vector<LightSample> sample(const GpuScene& scene, const std::vector<LightItem>& items,
                                    SceneAccess access = SceneAccess::texel_buffers) const {
        const DeviceScene on_device(device(), scene, access);
        return map<LightSample>(
            access == SceneAccess::texel_buffers ? kernels::light_sample : kernels::light_sample_storage,
            items, {}, &on_device);
    }
    // All from one point.
    static std::vector<LightItem> random_items(vec3 from, size_t count, uint32_t seed) {
        Random random(seed);
        std::vector<LightItem> items(count, {.from = from});
        for (LightItem& item : items) {
            item.uc = random.bits();
            item.u.x = random.bits();
            item.u.y = random.bits();
        }
        return items;
    }
};

}  // namespace candela
