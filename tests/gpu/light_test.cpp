// Samples of flat lights: lights are chosen by their power, points uniformly by area, and the densities
// agree.
#include "gpu/light_fixture.h"

namespace candela {
namespace {

TEST_F(LightTest, LightsAreChosenByPowerAndPointsByArea) {
    expect_holds(test_flat_light_points(device(), test_effort()));
}

TEST_F(LightTest, ASampleSaysWhatArrivesAndHowLikelyItWas) {
    expect_holds(test_flat_light_values(device(), SceneAccess::texel_buffers));
    expect_holds(test_flat_light_values(device(), SceneAccess::storage_buffers));
}

TEST_F(LightTest, APointOnTheLightItselfReceivesNothingFromThere) {
    const LightItem at_the_sample{.from = vec3(0)};  // Light 0's corner.
    const LightItem in_the_plane{.from = vec3(-1, 0, 0)};
    for (const LightSample& s :
         sample(build_gpu_scene(scene_of_flat_lights(), SceneFrame{}), {at_the_sample, in_the_plane}))
        EXPECT_EQ(s.pdf, 0.0f);
}

// A panel that slopes a little: seen from afar, its points are rounded by more than its own coordinates are.
TEST_F(LightTest, AFarLightDoesNotShadowItself) {
    Scene scene = scene_with_camera(dvec3(0), dvec3(0, 0, -1), 1.0f);
    add_diffuse(scene, vec3(0.0f));
    scene.shapes.push_back(
        {.geometry = parallelogram(vec3(-1, 0, 0.01f), vec3(2, 0, 0.003f), vec3(0, 1, 0.002f)),
         .material = 0,
         .emission = Emission{.radiance = vec3(1), .two_sided = false}});
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    uint32_t seed = 70;
    for (const float distance : {1.0f, 1e2f, 1e3f, 1e4f, 1e5f}) {
        const vec3 from = distance * normalize(vec3(0.5f, 0.4f, 1));
        for (const LightSample& s : sample(gpu, random_light_items(from, 2000, seed++)))
            ASSERT_EQ(s.occluded, 0u) << distance << " m away";
    }
}

}  // namespace
}  // namespace candela
