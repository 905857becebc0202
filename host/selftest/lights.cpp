// See lights.h: what all kinds of light share.
#include "selftest/lights.h"

#include "probe/random.h"

namespace candela {

std::vector<LightSample> sample_lights(const vk::Device& device, const GpuScene& scene,
                                       const std::vector<LightItem>& items, SceneAccess access) {
    const DeviceScene on_device(device, scene, access);
    return probe<LightSample>(device, kernels::light_sample, items, {}, &on_device);
}

std::vector<LightItem> random_light_items(vec3 from, size_t count, uint32_t seed) {
    Random random(seed);
    std::vector<LightItem> items(count, {.from = from});
    for (LightItem& item : items) {
        item.choice = random.bits();
        item.u.x = random.bits();
        item.u.y = random.bits();
    }
    return items;
}

}  // namespace candela
