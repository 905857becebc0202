// Estimators, samplers and roulette change the noise of an image, never its expectation.
#include "estimator_fixture.h"
#include "scene/names.h"

namespace candela {
namespace {

// A room with every kind of light: a parallelogram, a quad that is none, a glowing mesh, one that emits from
// both sides and hangs free, one that also reflects; of very different power.
Scene scene_with_lights() {
    Scene scene = open_room();
    const uint32_t grey = 0;
    const uint32_t black = add_diffuse(scene, vec3(0));
    add_shape(scene, parallelogram(vec3(-1, 1.99f, -1), vec3(0.8f, 0, 0), vec3(0, 0, 0.8f)), black,
              Emission{vec3(4, 3, 2), false});
    add_shape(scene,
              Quad{{dvec3(0.5, 1.9, -1), dvec3(1.5, 1.9, -1.2), dvec3(1.2, 1.9, 0), dvec3(0.6, 1.9, -0.2)}},
              grey, Emission{vec3(1, 2, 3), false});
    add_shape(scene, parallelogram(vec3(-1.5f, 0.5f, -1), vec3(0.8f, 0, 0.3f), vec3(0, 0.9f, 0)), grey,
              Emission{vec3(2), true});
    add_shape(scene, transformed(sphere_mesh(6, 8), [](vec3 p) { return vec3(0.7f, 0.8f, 0) + 0.3f * p; }),
              grey, Emission{vec3(3, 1, 1), false});
    return scene;
}

TEST_F(EstimatorTest, AgreeOnTheCornellBox) {
    expect_estimators_agree(cornell_box(), 2048, 576);
}

TEST_F(EstimatorTest, AgreeOnManyKindsOfLights) {
    expect_estimators_agree(scene_with_lights(), 512, 256);
}

// Beside lights of surfaces, a point, a spot, two suns and an uneven sky.
TEST_F(EstimatorTest, AgreeHoweverLightsAreChosen) {
    Scene scene = scene_with_lights();
    scene.lights.push_back({"", PointLight{.position = {0.5, 1.2, 0.8}, .intensity = vec3(0.5f)}});
    scene.lights.push_back({"", SpotLight{.position = {-0.5, 1.5, 0.5},
                                          .direction = {0, -1, 0},
                                          .intensity = vec3(1, 2, 1),
                                          .cone = {.inner_angle = 0.2f, .outer_angle = 0.6f}}});
    scene.lights.push_back({"", DirectionalLight{.direction = {0.2, -0.3, -1}, .irradiance = vec3(0.5f)}});
    scene.lights.push_back({"", DirectionalLight{.direction = {1, -1, 0.1}, .irradiance = vec3(0, 0, 1)}});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(0.2f), vec3(1, 0.5f, 0.1f)}};
    const Image by_tree = image(scene, settings(Estimator::mis, 8), 256);
    {
        SCOPED_TRACE("light samples only");
        expect_same_expectation(image(scene, settings(Estimator::light, 9), 256), by_tree);
    }
    for (const LightSampler sampler : {LightSampler::uniform, LightSampler::power}) {
        SCOPED_TRACE(name_of(sampler, LIGHT_SAMPLER_NAMES));
        RenderSettings other = settings(Estimator::mis, 10);
        other.light_sampler = sampler;
        expect_same_expectation(image(scene, other, 512), by_tree);
    }
}

TEST_F(EstimatorTest, RouletteKeepsTheMean) {
    const Scene scene = scene_with_lights();
    RenderSettings always = settings(Estimator::mis, 6);
    always.rr_depth = 0;
    RenderSettings never = settings(Estimator::mis, 7);
    never.rr_depth = DEPTH_SAFETY_LIMIT;
    expect_same_expectation(image(scene, always, 256), image(scene, never, 128));
}

// Smooth normals: directions that the shading normal offers but the surface does not are lost alike in all
// estimators.
TEST_F(EstimatorTest, AgreeOnSmoothNormals) {
    Scene scene = scene_with_lights();
    TriangleMesh ball = sphere_mesh(8, 12);
    ball.normals = ball.positions;
    ball = transformed(ball, [](vec3 p) { return vec3(-0.3f, 0.6f, 0.3f) + 0.5f * p; });
    add_shape(scene, ball, 0);
    expect_estimators_agree(scene, 512, 256);
}

}  // namespace
}  // namespace candela
