// Estimators agree on every material under every kind of light. Lights are large and lobes are wide enough
// for each estimator alone to have a small variance.
#include "estimator_fixture.h"

namespace candela {
namespace {

constexpr vec3 WARM(4, 3, 2), COOL(1, 2, 3);

// A dim sky with a bright texel up in front of the room.
Environment textured_sky() {
    Environment sky = one_bright_texel({8, 4}, {4, 1}, vec3(5, 4, 3));
    for (uint32_t i = 0; i < 32; ++i)
        sky.radiance[i] += vec3(0.2f, 0.3f, 0.4f) * (1.0f + float(i % 3));
    sky.rotation = 2.5f;
    return sky;
}

void add_round_lights(Scene& scene) {
    const uint32_t grey = 0;
    add_shape(scene, Sphere{dvec3(-1.2, 1.3, -1), 0.4}, grey, Emission{WARM, false});
    add_shape(scene, Sphere{dvec3(1.4, 0.5, -1.2), 0.3}, grey, Emission{COOL, true});
    add_shape(scene, Disk{dvec3(0, 1.95, -0.5), dvec3(0.6, 0, 0), dvec3(0, 0, 0.4)}, grey,
              Emission{COOL, false});
    add_shape(scene, Disk{dvec3(0.2, 1.2, -1.7), dvec3(0.4, 0.1, 0), dvec3(0, 0.4, 0.1)}, grey,
              Emission{WARM, true});
}

// Four balls on the floor.
void add_balls(Scene& scene, const std::vector<decltype(Material::model)>& models) {
    for (size_t i = 0; i < models.size(); ++i) {
        const float x = -1.2f + 0.8f * float(i);
        add_shape(scene, Sphere{dvec3(x, 0.4, 0.2), 0.35}, add_material(scene, models[i]));
    }
}

using GlossyEstimatorTest = EstimatorTest;

TEST_F(GlossyEstimatorTest, AgreeOnRoundLightsAndASky) {
    Scene scene = open_room();
    scene.environment = textured_sky();
    add_round_lights(scene);
    add_balls(scene, {DiffuseMaterial{vec3(0.7f, 0.5f, 0.3f)}, DiffuseMaterial{vec3(0.9f)}});
    expect_estimators_agree(scene, 512, 512);
}

// The tree does not know of lobes: in narrow ones, few of its light samples have most of the light.
TEST_F(GlossyEstimatorTest, AgreeOnPhongAndMetal) {
    Scene scene = open_room();
    scene.environment = textured_sky();
    add_round_lights(scene);
    add_balls(scene, {PhongMaterial{vec3(0.3f, 0.2f, 0.1f), vec3(0.6f, 0.5f, 0.4f), 10.0f},
                      PhongMaterial{vec3(0.1f, 0.2f, 0.3f), vec3(0.5f), 1000.0f},
                      ConductorMaterial{vec3(0.9f, 0.7f, 0.4f), 0.5f},
                      ConductorMaterial{vec3(0.8f, 0.8f, 0.9f), 0.05f}});
    expect_estimators_agree(scene, 512, 2048, LightSampler::power);
}

// Light samples do not find what lies behind a mirror or glass: there, emission that a path hits is added in
// full.
TEST_F(GlossyEstimatorTest, AgreeOnMirrorsAndGlass) {
    Scene scene = open_room();
    scene.environment = constant_environment(vec3(0.5f, 0.6f, 0.7f));
    add_round_lights(scene);
    add_balls(scene,
              {MirrorMaterial{vec3(0.9f, 0.8f, 0.7f)}, DielectricMaterial{.inside = {vec3(2, 1, 0.5f)}},
               DielectricMaterial{.ior = 1.8f, .fresnel = Fresnel::exact}, MirrorMaterial{vec3(0.9f)}});
    expect_estimators_agree(scene, 1024, 1024);
}

// The room is within a sphere that shines inwards, with the camera.
TEST_F(GlossyEstimatorTest, AgreeWithinALight) {
    Scene scene = open_room();
    add_shape(scene, Sphere{dvec3(0.5, 1, 0), 5.0}, 0, Emission{vec3(0.5f, 0.7f, 0.9f), true});
    add_balls(scene, {DiffuseMaterial{vec3(0.5f)}, PhongMaterial{vec3(0.1f), vec3(0.7f), 10.0f},
                      ConductorMaterial{vec3(0.9f, 0.7f, 0.4f), 0.5f}, DielectricMaterial{}});
    expect_estimators_agree(scene, 512, 1024);
}

// The sky lights the room, though no camera ray sees it.
TEST_F(GlossyEstimatorTest, AgreeOnAHiddenSky) {
    Scene scene = open_room();
    scene.environment = textured_sky();
    scene.environment->visible = false;
    add_balls(scene, {PhongMaterial{vec3(0.3f, 0.2f, 0.1f), vec3(0.6f, 0.5f, 0.4f), 10.0f},
                      ConductorMaterial{vec3(0.9f, 0.7f, 0.4f), 0.5f}, DielectricMaterial{}});
    expect_estimators_agree(scene, 512, 512);
}

// After Veach: a smooth and a rough plate under a small bright and a large dim lamp of the same power. BSDF
// samples seldom find the small one from the rough plate, light samples seldom that part of the large one
// which the smooth plate mirrors.
TEST_F(GlossyEstimatorTest, AgreeOnPlatesUnderASmallAndALargeLamp) {
    Scene scene = scene_with_camera(dvec3(0, 1.5, 4), dvec3(0, 0.2, 0), 0.6f);
    const uint32_t black = add_diffuse(scene, vec3(0));
    const uint32_t smooth = add_material(scene, PhongMaterial{vec3(0.1f), vec3(0.8f, 0.7f, 0.6f), 2000.0f});
    const uint32_t rough = add_material(scene, ConductorMaterial{vec3(0.6f, 0.7f, 0.8f), 0.4f});
    add_shape(scene, parallelogram(vec3(-2, 0, 0), vec3(4, 0, 0), vec3(0, 0, -1)), smooth);
    add_shape(scene, parallelogram(vec3(-2, 0, 1), vec3(4, 0, 0), vec3(0, 0, -1)), rough);
    add_shape(scene, Sphere{dvec3(0.7, 0.9, -1.5), 0.1}, black, Emission{25.0f * COOL, false});
    add_shape(scene, Sphere{dvec3(-0.7, 0.9, -1.5), 0.5}, black, Emission{WARM, false});
    expect_estimators_agree(scene, 2048, 2048);
}

// From outside the glass only BSDF samples find the lamp, and count in full; on the ball beside it in the
// glass both kinds find it, but for the light that comes back from the boundary.
TEST_F(GlossyEstimatorTest, AgreeOnALampWithinGlass) {
    Scene scene = open_room();
    add_shape(scene, Sphere{dvec3(0, 0.8, 0), 0.7},
              add_material(scene, DielectricMaterial{.inside = {vec3(1, 0.5f, 0.2f)}}));
    add_shape(scene, Sphere{dvec3(-0.3, 0.9, 0), 0.25}, 0, Emission{WARM, false});
    add_shape(scene, Sphere{dvec3(0.3, 0.7, 0), 0.25}, add_diffuse(scene, vec3(0.9f)));
    expect_estimators_agree(scene, 1024, 1024);
}

// A lens and a lobe might use the same random numbers: samplers keep the mean with all features at once. The
// samples of a stratified pixel depend on each other, the means of renderings with other seeds do not.
TEST_F(GlossyEstimatorTest, SamplersAgreeOnEverything) {
    const Scene scene = scene_of_everything();
    RenderSettings s = settings(Estimator::mis, 4);
    const Replicates independent = replicates(scene, s, 16);
    for (const SamplerKind sampler : {SamplerKind::stratified, SamplerKind::sobol}) {
        SCOPED_TRACE(int(sampler));
        s.sampler = sampler;
        s.seed += SEEDS;
        expect_same_expectation(replicates(scene, s, 16), independent);
    }
}

TEST_F(GlossyEstimatorTest, RouletteKeepsTheMeanOfEverything) {
    const Scene scene = scene_of_everything();
    RenderSettings always = settings(Estimator::mis, 6);
    always.rr_depth = 0;
    RenderSettings never = settings(Estimator::mis, 7);
    never.rr_depth = DEPTH_SAFETY_LIMIT;
    expect_same_expectation(image(scene, always, 512), image(scene, never, 256));
}

}  // namespace
}  // namespace candela
