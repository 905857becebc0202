// Directional lights with a disk: what a Lambert floor reflects of them has closed forms, and rays find them,
// too.
#include <cmath>

#include "estimator_fixture.h"

namespace candela {
namespace {

constexpr vec3 IRRADIANCE(1, 2, 3);

class SunTest : public EstimatorTest {
  protected:
    static RenderSettings settings(Estimator estimator) {
        RenderSettings s = independent_settings(16, estimator, 0);
        s.max_depth = 1;
        return s;
    }
    static Light sun(dvec3 direction, double degrees) {
        return {"", DirectionalLight{direction, IRRADIANCE, float(degrees * DEGREE)}};
    }
    static Scene floor_under(dvec3 direction, double degrees) {
        Scene scene = floor_seen_closely(REFLECTANCE);
        scene.lights = {sun(direction, degrees)};
        return scene;
    }
    void expect_irradiance(const Scene& scene, double cosine, uint32_t spp, Estimator estimator) const {
        expect_mean(image_of(render(scene, settings(estimator), samples(spp))),
                    glm::dvec3(REFLECTANCE) / M_PI * cosine * glm::dvec3(IRRADIANCE), 2e-4);
    }
    // The radiance of the disk.
    static glm::dvec3 radiance(double degrees) {
        const double sine = std::sin(0.5 * degrees * DEGREE);
        return glm::dvec3(IRRADIANCE) / (M_PI * sine * sine);
    }
};

// A disk that is above the horizon sends what a single direction does.
TEST_F(SunTest, ADiskLightsLikeItsMiddle) {
    for (const double degrees : {0.005, 0.53, 10.0, 100.0}) {
        for (const dvec3 direction : {dvec3(0, -1, 0), dvec3(1, -2, 0)}) {
            SCOPED_TRACE(testing::Message() << degrees << " degrees, " << direction.x);
            const Scene scene = floor_under(direction, degrees);
            const double cosine = -direction.y / length(direction);
            expect_irradiance(scene, cosine, 1024, Estimator::light);
            expect_irradiance(scene, cosine, 1024, Estimator::mis);
            if (degrees > 50.0) expect_irradiance(scene, cosine, 4096, Estimator::bsdf);
        }
    }
}

// An edge above hides half of it.
TEST_F(SunTest, AnEdgeBeforeItsMiddleHalvesIt) {
    Scene scene = floor_under(dvec3(0, -1, 0), 10.0);
    add_shape(scene, parallelogram(vec3(0, 2, -50), vec3(0, 0, 100), vec3(50, 0, 0)), 1);
    for (const Estimator estimator : {Estimator::light, Estimator::mis})
        expect_irradiance(scene, 0.5, 4096, estimator);
}

// The mirrored view of the floor's middle goes to the middle of the sun, or a degree past it.
TEST_F(SunTest, AMirrorShowsIt) {
    for (const Estimator estimator : ESTIMATORS) {
        for (const double past : {0.0, 1.0}) {
            const double rise = std::atan(0.2) + past * DEGREE;
            Scene scene = floor_under(dvec3(0, -std::sin(rise), std::cos(rise)), 0.53);
            scene.materials[0].model = MirrorMaterial{vec3(1)};
            const Image picture = image_of(render(scene, settings(estimator), 16));
            expect_mean(picture, past == 0.0 ? radiance(0.53) : glm::dvec3(0), 1e-4);
        }
    }
}

TEST_F(SunTest, TheCameraDoesNotSeeIt) {
    Scene scene = scene_with_camera(dvec3(0), dvec3(0, 0, -1), 0.1f);
    add_diffuse(scene, REFLECTANCE);
    add_shape(scene, Sphere{dvec3(0, 0, 5), 1.0}, 0);
    scene.lights = {sun(dvec3(0, 0, 1), 10.0)};
    const Image picture = image_of(render(scene, settings(Estimator::mis), 16));
    expect_pixels(picture, vec3(0));
    for (const float alpha : picture.find("A")->values)
        ASSERT_EQ(alpha, 0.0f);
}

// Around a corner and many times: two disks that overlap, a direction, a lamp and a sky.
TEST_F(SunTest, LightSamplesAndBothTogetherAgree) {
    Scene scene = open_room();
    add_shape(scene, Sphere{dvec3(0.6, 1.6, 0.3), 0.2}, add_diffuse(scene, vec3(0)), Emission{vec3(2, 1, 1)});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(0.1f), vec3(0.1f, 0.2f, 0.3f)}};
    scene.lights = {sun(dvec3(-1, -2, -0.5), 60.0), sun(dvec3(-0.5, -2, -0.5), 90.0),
                    sun(dvec3(0.2, -1, -0.5), 0.0)};
    for (const LightSampler sampler : {LightSampler::tree, LightSampler::power, LightSampler::uniform}) {
        SCOPED_TRACE(int(sampler));
        RenderSettings light = EstimatorTest::settings(Estimator::light, 2);
        RenderSettings both = EstimatorTest::settings(Estimator::mis, 1);
        light.light_sampler = both.light_sampler = sampler;
        const uint32_t spp = sampler == LightSampler::tree ? 256 : 512;
        expect_same_expectation(image(scene, light, spp), image(scene, both, spp));
    }
}

}  // namespace
}  // namespace candela
