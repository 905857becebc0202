// Samples of lights without a surface.
#include <cmath>

#include "gpu/light_fixture.h"

namespace candela {
namespace {

using PunctualLightTest = LightTest;

TEST_F(PunctualLightTest, TheyAreChosenByPowerAndSayWhatArrivesAndWhatHidesThem) {
    expect_holds(test_punctual_lights(device(), test_effort()));
}

TEST_F(PunctualLightTest, NothingArrivesAtTheLightItself) {
    Scene scene = scene_of_mesh({});
    scene.shapes.clear();
    add_shape(scene, parallelogram(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0)), 0);
    for (const auto& model : {decltype(Light::model)(PointLight{.position = dvec3(0.5)}),
                              decltype(Light::model)(SpotLight{.position = dvec3(0.5)})}) {
        scene.lights = {{"", model}};
        const LightItem there{.from = vec3(0.5f)};
        for (const LightSample& s : sample(build_gpu_scene(scene, SceneFrame{}), {there}))
            EXPECT_EQ(s.pdf, 0.0f);
    }
}

// What lies on a ceiling or a wall does not hide in it. Its plane is rounded by some multiples of 4 * 2^-24,
// the greatest coordinate, which is less than 2^-19 of a height above 1; seen from there at a cosine of 0.3
// or more, the rounding of the ray's direction is negligible.
TEST_F(PunctualLightTest, ALightOnASurfaceIsNotHiddenByIt) {
    Scene scene = scene_of_mesh({});
    scene.shapes.clear();
    const vec3 p(0.1f, 0.2f, 0.3f), e1(3, 0.7f, -0.4f), e2(0.3f, -2, 0.9f);
    add_shape(scene, parallelogram(p - 0.3f * e1 - 0.4f * e2, e1, e2), 0);
    const vec3 n = normalize(cross(e1, e2));
    scene.lights = {{"", PointLight{.position = dvec3(p)}}};
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    std::vector<LightItem> items = random_light_items(vec3(0), 4000, 270);
    for (size_t i = 0; i < items.size(); ++i) {
        const double turn = 2.4 * double(i);
        const auto height = float(std::pow(10.0, 3.0 * double(i % 100) / 100.0));
        const vec3 across =
            float(std::cos(turn)) * normalize(e1) + float(std::sin(turn)) * cross(n, normalize(e1));
        items[i].from = p + height * (n + 0.01f * float(i % 300) * across);
    }
    for (const LightSample& s : sample(gpu, items))
        EXPECT_EQ(s.occluded, 0u);
}

}  // namespace
}  // namespace candela
