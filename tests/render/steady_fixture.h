// What the tests share that render several states, or use a renderer that outlives its device.
#pragma once

#include <utility>
#include <vector>

#include "render_fixture.h"
#include "session/steady_renderer.h"

namespace candela {

class SteadyTest : public RenderTest {
  protected:
    // A renderer for the scene's first camera that goes on from `states`. No device may fail.
    SteadyRenderer steady_renderer(const Scene& scene, const GpuScene& gpu_scene,
                                   const RenderSettings& settings, std::vector<Accumulation> states,
                                   double copy_seconds = 10.0) const {
        return SteadyRenderer({.device = &slot_,
                               .scene = &gpu_scene,
                               .camera = &scene.cameras[0],
                               .settings = settings,
                               .states = std::move(states),
                               .copy_seconds = copy_seconds},
                              [](const Error&, uint32_t, double) { FAIL() << "the device failed"; });
    }

  private:
    mutable DeviceSlot slot_{instance_, info_, std::nullopt};
};

}  // namespace candela
