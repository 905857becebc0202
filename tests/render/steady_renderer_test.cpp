// A renderer that outlives its device: here, that it copies the state to the host in time. What it does when
// a device fails is in tests/cli/device_failure_test.cpp.
#include "session/steady_renderer.h"

#include "steady_fixture.h"

namespace candela {
namespace {

class SteadyRendererTest : public SteadyTest {
  protected:
    // Renders that many samples in many submissions, or until a new state has been held twice on the way;
    // returns how often that was.
    int copies_on_the_way(double copy_seconds, uint32_t target) const {
        const Scene scene = cornell_box();
        const GpuScene gpu_scene = build_gpu_scene(scene);
        RenderSettings settings = settings_for(64, 64);
        settings.submission_seconds = 1e-6;
        SteadyRenderer renderer =
            steady_renderer(scene, gpu_scene, settings, {empty_state(settings)}, copy_seconds);
        EXPECT_EQ(count_samples(renderer.states()).total, 0u);
        int copies = 0;
        uint64_t samples = 0;
        const bool complete = renderer.render(target, [&](double) {
            const uint64_t now = count_samples(renderer.states()).total;
            EXPECT_GE(now, samples);
            copies += now > samples ? 1 : 0;
            samples = now;
            return copies < 2;
        });
        if (copies < 2) {
            EXPECT_TRUE(complete);
            EXPECT_EQ(count_samples(renderer.states()).total, uint64_t(target) * 64 * 64);
        }
        return copies;
    }
};

TEST_F(SteadyRendererTest, CopiesTheStateInTime) {
    // However fast the device is: two copies need a few of its submissions, and this many samples thousands.
    EXPECT_EQ(copies_on_the_way(1e-6, 16'384), 2);
    EXPECT_EQ(copies_on_the_way(1e9, 16), 0);
}

}  // namespace
}  // namespace candela
