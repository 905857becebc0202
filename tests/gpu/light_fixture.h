// What the tests of lights share: light samples on the device, by the kernel light_sample.comp.glsl.
#pragma once

#include <vector>

#include "gpu/device_fixture.h"
#include "selftest/lights.h"
#include "support/scene_builders.h"

namespace candela {

class LightTest : public DeviceTest {
  protected:
    std::vector<LightSample> sample(const GpuScene& scene, const std::vector<LightItem>& items) const {
        return sample_lights(device(), scene, items);
    }
};

}  // namespace candela
