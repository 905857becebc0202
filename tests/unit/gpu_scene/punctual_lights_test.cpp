// Point, spot and directional lights as records: their place and strength in the frame, and the power by
// which they are chosen.
#include "gpu_scene/punctual_lights.h"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/base/base_fixture.h"
#include "unit/gpu_scene/packed_scene.h"

namespace candela {
namespace {

constexpr double INNER = 0.3;
constexpr double OUTER = 0.9;

// The factor of a spot's intensity, as in the text of glTF's KHR_lights_punctual.
double falloff(double angle) {
    const double scale = 1.0 / (std::cos(INNER) - std::cos(OUTER));
    const double offset = -std::cos(OUTER) * scale;
    const double attenuation = std::clamp(std::cos(angle) * scale + offset, 0.0, 1.0);
    return attenuation * attenuation;
}

// A square lamp, and one light of each kind.
Scene scene_of_lights() {
    Scene scene = scene_of_shapes({emitter(SQUARE, vec3(5))});
    scene.lights = {
        {"sun", DirectionalLight{.direction = dvec3(0, 0, -3), .irradiance = vec3(4)}},
        {"bulb", PointLight{.position = dvec3(1, 2, 3), .intensity = vec3(0, 2, 0)}},
        {"lamp", SpotLight{.position = dvec3(-1, 0, 2),
                           .direction = dvec3(0, 4, -3),
                           .intensity = vec3(3),
                           .cone = {.inner_angle = float(INNER), .outer_angle = float(OUTER)}}},
    };
    return scene;
}

// Over pi: the lamp's radiance times its area; irradiance times the squared radius of the sphere around the
// square's box, 1/2; the mean intensity over all directions times four.
TEST(PunctualLights, AreChosenByTheirPower) {
    double mean = 0.0;  // Over the sphere of directions.
    constexpr int STEPS = 20000;
    for (int i = 0; i < STEPS; ++i)
        mean += falloff(std::acos((i + 0.5) / STEPS)) / (2.0 * STEPS);
    const std::vector<double> powers{5.0, 4.0 * 2.0 * 0.7152, 4.0 * 3.0 * mean, 4.0 * 0.5};
    double total = 0.0;
    for (const double power : powers)
        total += power;
    const Scene scene = scene_of_lights();
    for (const SceneFrame& frame : {SceneFrame{}, SceneFrame{.origin = dvec3(10, 20, 30), .unit = 8.0}}) {
        const GpuScene gpu = build_gpu_scene(scene, frame);
        ASSERT_EQ(gpu.light_count, powers.size());
        const std::vector<double> chosen = light_probabilities(gpu);
        for (uint32_t i = 0; i < gpu.light_count; ++i) {
            EXPECT_NEAR(chosen[i], powers[i] / total, 1e-6) << i;
            EXPECT_NEAR(double(light(gpu, i).pmf), powers[i] / total, 1e-6) << i;
        }
        EXPECT_EQ(gpu.lights_present,
                  1u << LIGHT_PARALLELOGRAM | 1u << LIGHT_POINT | 1u << LIGHT_SPOT | 1u << LIGHT_DIRECTIONAL);
    }
}

// The mean of smoothstep between the angles is a half.
TEST(PunctualLights, ASpotThatFallsOffSmoothlyHasMorePower) {
    Scene scene = scene_of_lights();
    scene.lights.erase(scene.lights.begin());
    std::get<SpotLight>(scene.lights[1].model).cone.falloff = SpotFalloff::smoothstep;
    const double spot = 3.0 * 2.0 * (1.0 - 0.5 * (std::cos(INNER) + std::cos(OUTER)));
    const double total = 5.0 + 4.0 * 2.0 * 0.7152 + spot;
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    EXPECT_NEAR(double(light(gpu, 2).pmf), spot / total, 1e-6);
    EXPECT_EQ(light(gpu, 2).e2.z, 1.0f);
}

// A disk has the power of its middle; floats do not tell the directions of a tiny one apart.
TEST(PunctualLights, ASunMayHaveADisk) {
    Scene scene = scene_of_lights();
    const GpuScene plain = build_gpu_scene(scene, SceneFrame{});
    auto& sun = std::get<DirectionalLight>(scene.lights[0].model);
    sun.angle = 1.0f;
    const GpuScene disk = build_gpu_scene(scene, SceneFrame{});
    EXPECT_EQ(light(disk, 3).kind, LIGHT_SUN);
    EXPECT_NEAR(double(light(disk, 3).e2.x), 1.0 - std::cos(0.5), 1e-7);
    EXPECT_NEAR(double(light(disk, 3).radiance.x), 4.0 / (M_PI * std::pow(std::sin(0.5), 2)), 1e-5);
    for (uint32_t i = 0; i < disk.light_count; ++i)
        EXPECT_FLOAT_EQ(light(disk, i).pmf, light(plain, i).pmf) << i;
    for (const int c : {0, 1, 2, 3})
        EXPECT_NEAR(disk.light_groups.sun_flux[c], plain.light_groups.sun_flux[c], 1e-6);
    sun.angle = 0.9e-4f;
    EXPECT_EQ(light(build_gpu_scene(scene, SceneFrame{}), 3).kind, LIGHT_DIRECTIONAL);
}

// A sun beside a lamp of 10^12 times its power: the probability is that of the choice, a unit of a share.
TEST(PunctualLights, EveryGroupIsChosenNowAndThen) {
    Scene scene = scene_of_shapes({emitter(SQUARE, vec3(1e12f))});
    scene.lights = {{"sun", DirectionalLight{.irradiance = vec3(2)}}};
    const GpuScene gpu = build_gpu_scene(scene, SceneFrame{});
    EXPECT_EQ(gpu.light_groups.sun_fraction, 1u);
    EXPECT_EQ(light(gpu, 1).pmf, 0x1p-31f);
    scene = scene_of_shapes({emitter(SQUARE, vec3(1))});
    scene.lights = {{"sun", DirectionalLight{.irradiance = vec3(2e12f)}}};
    const GpuScene bright = build_gpu_scene(scene, SceneFrame{});
    EXPECT_EQ(bright.light_groups.sun_fraction, (1u << 31) - 1u);
    EXPECT_EQ(light(bright, 0).pmf, 0x1p-31f);
}

// Where lengths are eight times shorter, an intensity has a sixty-fourth of its number.
TEST(PunctualLights, AreInTheFrameOfTheScene) {
    const GpuScene gpu =
        build_gpu_scene(scene_of_lights(), SceneFrame{.origin = dvec3(10, 20, 30), .unit = 8.0});
    const LightRecord bulb = light(gpu, 1), lamp = light(gpu, 2), sun = light(gpu, 3);
    EXPECT_EQ(sun.kind, LIGHT_DIRECTIONAL);
    EXPECT_EQ(sun.e1, vec3(0, 0, 1));
    EXPECT_EQ(sun.radiance, vec3(4));
    EXPECT_EQ(bulb.kind, LIGHT_POINT);
    EXPECT_EQ(bulb.p, vec3(-9, -18, -27) / 8.0f);
    EXPECT_EQ(bulb.radiance, vec3(0, 2, 0) / 64.0f);
    EXPECT_EQ(lamp.kind, LIGHT_SPOT);
    EXPECT_EQ(lamp.p, vec3(-11, -20, -28) / 8.0f);
    EXPECT_EQ(lamp.e1, vec3(0, 0.8f, -0.6f));
    EXPECT_EQ(lamp.radiance, vec3(3) / 64.0f);
    EXPECT_NEAR(double(lamp.e2.x), 1.0 - std::cos(OUTER), 1e-7);
    EXPECT_NEAR(double(lamp.e2.y), 1.0 / (std::cos(INNER) - std::cos(OUTER)), 1e-6);
}

TEST(PunctualLights, DoNotCountIfTheyAreBlackOrThereIsNothingToLight) {
    Scene scene = scene_of_shapes({{.geometry = SQUARE, .material = 0, .emission = {}}});
    scene.lights = {{"", PointLight{.intensity = vec3(0)}},
                    {"", SpotLight{.intensity = vec3(0)}},
                    {"", DirectionalLight{.irradiance = vec3(0)}}};
    EXPECT_EQ(build_gpu_scene(scene).light_count, 0u);
    Scene empty = scene_of_shapes({});
    empty.lights = {{"", DirectionalLight{}}};
    EXPECT_EQ(build_gpu_scene(empty).light_count, 0u);
}

// Spots with angles whose cosines are the same float, or the same double, or that are equal.
TEST(PunctualLights, ASpotMayBeAsNarrowAndHardAsFloatsCanSay) {
    const std::pair<float, float> cones[] = {
        {0.0f, 1e-30f}, {1e-12f, 1.0000001e-12f}, {0.5f, std::nextafter(0.5f, 1.0f)}, {0.5f, 0.5f}};
    for (const auto& [inner, outer] : cones) {
        Scene scene = scene_of_shapes({{.geometry = SQUARE, .material = 0, .emission = {}}});
        scene.lights = {{"", PointLight{}},
                        {"", SpotLight{.cone = {.inner_angle = inner, .outer_angle = outer}}}};
        const GpuScene gpu = build_gpu_scene(scene);
        for (uint32_t i = 0; i < gpu.light_count; ++i) {
            const LightRecord l = light(gpu, i);
            EXPECT_TRUE(std::isfinite(l.e2.x) && std::isfinite(l.e2.y) && std::isfinite(l.pmf)) << outer;
        }
    }
}

TEST(PunctualLights, AreRefusedWhereFloatsCannotHoldThem) {
    Scene scene = scene_of_shapes({{.geometry = SQUARE, .material = 0, .emission = {}}});
    scene.lights = {{"star", PointLight{.position = dvec3(0, 0, 1e19)}}};
    EXPECT_EQ(error_of([&] { build_gpu_scene(scene); }),
              "the light \"star\" is too far from the scene for 32-bit floats; use a directional light");
    scene.lights = {{"flash", SpotLight{.intensity = vec3(0, 1e30f, 0)}}};
    EXPECT_EQ(error_of([&] { build_gpu_scene(scene, SceneFrame{.origin = dvec3(0), .unit = 0x1p-20}); }),
              "the light \"flash\" is too bright for 32-bit floats in a scene of this size; give it a lower "
              "intensity");
    scene.lights = {{"sun", DirectionalLight{.irradiance = vec3(1e35f), .angle = 1e-3f}}};
    EXPECT_EQ(
        error_of([&] { build_gpu_scene(scene); }),
        "the light \"sun\" is too bright for 32-bit floats; give it a lower irradiance or a wider angle");
}

}  // namespace
}  // namespace candela
