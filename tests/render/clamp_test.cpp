// The limit of light that has bounced more than once.
#include "render_fixture.h"

namespace candela {
namespace {

class ClampTest : public RenderTest {
  protected:
    // The picture with a limit, every pixel of which has the same value.
    vec3 colour(const Scene& scene, std::optional<float> limit, Estimator estimator) const {
        RenderSettings settings = settings_for(4, 4);
        settings.estimator = estimator;
        settings.clamp_indirect = limit;
        settings.max_depth = 2;
        const Image image = image_of(render(scene, settings, 1));
        const vec3 first(plane(image, "", 0)[0], plane(image, "", 1)[0], plane(image, "", 2)[0]);
        for (size_t c = 0; c < 3; ++c) {
            for (const float value : plane(image, "", c))
                EXPECT_NEAR(value, first[glm::length_t(c)], 1e-6f);
        }
        return first;
    }
    static void expect_near(vec3 a, vec3 b) {
        EXPECT_LE(length(a - b), 1e-5f * length(b)) << a.x << ", not " << b.x;
    }
};

// Parallel rays that fall on a mirror at 45 degrees, and on as many more as there are, at right angles.
Scene scene_of_mirrors(uint32_t mirrors) {
    Scene scene = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.0f);
    scene.cameras[0].ortho_height = 0.1;
    scene.materials = {{.name = "mirror", .model = MirrorMaterial{}}};
    // From -Z to +X, and at x = 2 to +Z.
    const dvec3 up(0, 4, 0);
    add_shape(scene, parallelogram(dvec3(-1, -2, 1), dvec3(2, 0, -2), up), 0);
    if (mirrors > 1) add_shape(scene, parallelogram(dvec3(1, -2, -1), dvec3(2, 0, 2), up), 0);
    return scene;
}

// The limit applies to the mean of the channels, and keeps the colour.
TEST_F(ClampTest, ScalesLightThatHasBouncedTwiceToTheLimit) {
    for (const Estimator estimator : ESTIMATORS) {
        Scene once = scene_of_mirrors(1), twice = scene_of_mirrors(2);
        for (Scene* scene : {&once, &twice})
            scene->environment = constant_environment(RADIANCE);
        expect_near(colour(once, 0.5f, estimator), RADIANCE);
        expect_near(colour(twice, {}, estimator), RADIANCE);
        expect_near(colour(twice, 2.5f, estimator), RADIANCE);
        expect_near(colour(twice, 0.5f, estimator), 0.25f * RADIANCE);
        // A lamp instead of the sky.
        twice.environment.reset();
        add_diffuse(twice, vec3(0));
        add_shape(twice, parallelogram(dvec3(-9, -9, 9), dvec3(18, 0, 0), dvec3(0, 18, 0)), 1,
                  Emission{.radiance = RADIANCE, .two_sided = true});
        expect_near(colour(twice, {}, estimator), RADIANCE);
        expect_near(colour(twice, 0.5f, estimator), 0.25f * RADIANCE);
    }
}

// A point light straight before a wall of reflectance r gives I r / (pi d^2), within the picture's height.
// Seen in a mirror, it has bounced twice.
TEST_F(ClampTest, AppliesToLightSamples) {
    Scene direct = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.0f);
    direct.cameras[0].ortho_height = 1e-3;
    add_diffuse(direct, vec3(0.5f));
    add_shape(direct, parallelogram(dvec3(-9, -9, 0), dvec3(18, 0, 0), dvec3(0, 18, 0)), 0);
    direct.lights = {{"", PointLight{dvec3(0, 0, 2), RADIANCE}}};
    const vec3 lit = RADIANCE * float(0.5 / M_PI / 4.0);
    expect_near(colour(direct, 0.01f, Estimator::light), lit);

    Scene seen = scene_of_mirrors(1);
    seen.cameras[0].ortho_height = 1e-3;
    add_diffuse(seen, vec3(0.5f));
    add_shape(seen, parallelogram(dvec3(4, -9, -9), dvec3(0, 0, 18), dvec3(0, 18, 0)), 1);
    seen.lights = {{"", PointLight{dvec3(2, 0, 0), RADIANCE}}};
    expect_near(colour(seen, {}, Estimator::light), lit);
    expect_near(colour(seen, 0.01f, Estimator::light), RADIANCE * 0.005f);
}

}  // namespace
}  // namespace candela
