// What the tests of lights share: light samples on the device, by the kernel light_sample.comp.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "gpu/chi_squared.h"
#include "gpu/device_fixture.h"
#include "support/reference_random.h"
#include "support/scene_builders.h"

namespace candela {

// Random bits for a light sample from a reference point: one word chooses the light, two the point.
struct LightItem {
    vec3 from{0};
    uint32_t uc = 0;
    uvec2 u{0};
    uvec2 unused{0};
};

struct LightSample {
    vec3 wi, Li;
    float pdf;
    vec3 shadow;
    float t_max;
    uint32_t occluded;  // The shadow ray is.
    // What a ray in the direction wi meets: a light, or NO_LIGHT for anything else and for the sky; the
    // density that light samples have there; and its radiance.
    uint32_t light_met;
    float pdf_met;
    vec3 Li_met;
};

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
