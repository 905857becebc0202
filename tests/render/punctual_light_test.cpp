// Lights without a surface: what a Lambert floor reflects of them has closed forms, and only light samples
// find them.
#include <cmath>

#include "estimator_fixture.h"

namespace candela {
namespace {

constexpr vec3 INTENSITY(1, 2, 3);

class PunctualLightTest : public EstimatorTest {
  protected:
    static RenderSettings settings(Estimator estimator) {
        RenderSettings s = independent_settings(16, estimator, 0);
        s.max_depth = 1;
        return s;
    }
    // A floor at y = 0, seen at the origin, under one light.
    static Scene floor_under(const decltype(Light::model)& light) {
        Scene scene = floor_seen_closely(REFLECTANCE);
        scene.lights = {{"", light}};
        return scene;
    }
    // As in direct_light_test.cpp: the camera sees 7 mm of a floor 1 m or more from the lights. A light that
    // is alone has no other noise than that over the floor; several need more samples.
    void expect_irradiance(const Scene& scene, glm::dvec3 irradiance, uint32_t spp = 16,
                           Estimator estimator = Estimator::mis) const {
        expect_mean(image_of(render(scene, settings(estimator), samples(spp))),
                    glm::dvec3(REFLECTANCE) / M_PI * irradiance, 2e-4);
    }
    void expect_black(const Scene& scene, Estimator estimator = Estimator::mis) const {
        expect_pixels(image_of(render(scene, settings(estimator), 16)), vec3(0));
    }
};

// I cos / d^2, with cos = height / d.
glm::dvec3 point_irradiance(dvec3 position) {
    const double distance = length(position);
    return glm::dvec3(INTENSITY) * position.y / (distance * distance * distance);
}

TEST_F(PunctualLightTest, APointLightsByTheInverseSquareAndTheCosine) {
    for (const dvec3 position : {dvec3(0, 1, 0), dvec3(3, 2, -1), dvec3(0, 40, 90)}) {
        expect_irradiance(floor_under(PointLight{position, INTENSITY}), point_irradiance(position));
    }
    expect_black(floor_under(PointLight{dvec3(0, -1, 0), INTENSITY}));
}

// In the words of glTF's KHR_lights_punctual, or as smoothstep. The axis is at that angle to the direction
// towards the origin.
TEST_F(PunctualLightTest, ASpotFallsOffBetweenItsAngles) {
    constexpr double INNER = 0.2, OUTER = 0.6;
    const double scale = 1.0 / (std::cos(INNER) - std::cos(OUTER));
    const double offset = -std::cos(OUTER) * scale;
    const dvec3 position(0, 20, 0);  // So far up, all of the floor that is seen has the same angle.
    for (const double angle : {0.1, 0.25, 0.4, 0.55}) {
        const SpotLight light{.position = position,
                              .direction = dvec3(3.0 * std::sin(angle), -3.0 * std::cos(angle), 0),
                              .intensity = INTENSITY,
                              .cone = {.inner_angle = float(INNER), .outer_angle = float(OUTER)}};
        const double attenuation = std::min(std::cos(angle) * scale + offset, 1.0);
        const double square = attenuation * attenuation;
        expect_irradiance(floor_under(light), square * point_irradiance(position));
        SpotLight smooth = light;
        smooth.cone.falloff = SpotFalloff::smoothstep;
        expect_irradiance(floor_under(smooth),
                          square * (3.0 - 2.0 * attenuation) * point_irradiance(position));
    }
    for (const double angle : {0.61, 3.0}) {
        const dvec3 direction(std::sin(angle), -std::cos(angle), 0);
        expect_black(floor_under(SpotLight{position, direction, INTENSITY, {float(INNER), float(OUTER)}}));
        expect_black(floor_under(SpotLight{
            position, direction, INTENSITY, {float(INNER), float(OUTER), SpotFalloff::smoothstep}}));
    }
}

// The edge of a cone that is hard: all or nothing.
TEST_F(PunctualLightTest, ASpotMayHaveAHardEdge) {
    const dvec3 position(0, 20, 0);
    constexpr float ANGLE = 0.5f;
    for (const float from_axis : {0.49f, 0.51f}) {
        const dvec3 direction(std::sin(double(from_axis)), -std::cos(double(from_axis)), 0);
        const Scene scene =
            floor_under(SpotLight{position, direction, INTENSITY, {std::nextafter(ANGLE, 0.0f), ANGLE}});
        if (from_axis < ANGLE) {
            expect_irradiance(scene, point_irradiance(position));
        } else {
            expect_black(scene);
        }
    }
}

TEST_F(PunctualLightTest, ADirectionalLightDependsOnTheCosineAlone) {
    for (const dvec3 direction : {dvec3(0, -1, 0), dvec3(1, -2, 3), dvec3(-50, -1, 0)}) {
        expect_irradiance(floor_under(DirectionalLight{direction, INTENSITY}),
                          glm::dvec3(INTENSITY) * -direction.y / length(direction));
    }
    for (const double rise : {0.0, 0.01})  // Along the floor, and from below.
        expect_black(floor_under(DirectionalLight{dvec3(1, rise, 0), INTENSITY}));
}

// Lights of any powers add up; errors of the choice would not cancel.
TEST_F(PunctualLightTest, DimAndBrightLightsAddUp) {
    const dvec3 dim(0, 2, 1), bright(1, 1, 0), above(0, 2, 0);
    Scene scene = floor_under(PointLight{dim, 0.01f * INTENSITY});
    scene.lights.push_back({"", PointLight{bright, 2.0f * INTENSITY}});
    scene.lights.push_back({"", DirectionalLight{dvec3(0, -3, 4), 1e-3f * INTENSITY}});
    scene.lights.push_back({"", SpotLight{.position = above,
                                          .direction = dvec3(0, -1, 0),
                                          .intensity = INTENSITY,
                                          .cone = {.outer_angle = PI / 2}}});
    const glm::dvec3 irradiance = 0.01 * point_irradiance(dim) + 2.0 * point_irradiance(bright) +
                                  0.6e-3 * glm::dvec3(INTENSITY) + point_irradiance(above);
    for (const Estimator estimator : {Estimator::light, Estimator::mis})
        expect_irradiance(scene, irradiance, 4096, estimator);
}

// Of a light and a dimmer one in the same place, each sample is worth the same, so that there is no noise.
// The tree's parts of a node are whole numbers of 2^-15.
TEST_F(PunctualLightTest, SamplesOfLightsInOnePlaceAreWorthTheSame) {
    const dvec3 position(1, 2, 0);
    Scene scene = floor_under(PointLight{position, INTENSITY});
    const Image alone = image_of(render(scene, settings(Estimator::mis), 16));
    for (const auto& [sampler, dimmer] :
         {std::pair(LightSampler::power, 0.001f), {LightSampler::tree, 0.25f}}) {
        scene.lights = {{"", PointLight{position, INTENSITY * (1.0f - dimmer)}},
                        {"", PointLight{position, INTENSITY * dimmer}}};
        RenderSettings chosen = settings(Estimator::mis);
        chosen.light_sampler = sampler;
        const Image both = image_of(render(scene, chosen, 16));
        for (size_t c = 0; c < 3; ++c) {
            for (size_t i = 0; i < both.pixel_count(); ++i)
                ASSERT_NEAR(plane(both, "", c)[i], plane(alone, "", c)[i], 1e-5f * plane(alone, "", c)[i]);
        }
    }
}

TEST_F(PunctualLightTest, TheEstimatorBsdfIsBlindToThem) {
    expect_black(floor_under(PointLight{dvec3(0, 2, 0), INTENSITY}), Estimator::bsdf);
    expect_black(floor_under(SpotLight{.position = dvec3(0, 2, 0), .direction = dvec3(0, -1, 0)}),
                 Estimator::bsdf);
    expect_black(floor_under(DirectionalLight{dvec3(0, -1, 0), INTENSITY}), Estimator::bsdf);
}

// Around a corner and many times, beside a lamp and a sky: the light that arrives by BSDF samples as well is
// weighted, that of the others is not.
TEST_F(PunctualLightTest, LightSamplesAndBothTogetherAgree) {
    Scene scene = open_room();
    const uint32_t leaf =
        add_material(scene, DiffuseTransmissionMaterial{vec3(0.3f), vec3(0.5f, 0.4f, 0.3f)});
    add_shape(scene, parallelogram(vec3(-0.5f, 0.3f, 0.2f), vec3(0.9f, 0, 0), vec3(0, 0.6f, 0.3f)), leaf);
    add_shape(scene, Sphere{dvec3(0.6, 1.6, 0.3), 0.2}, add_diffuse(scene, vec3(0)), Emission{vec3(2, 1, 1)});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(0.1f), vec3(0.1f, 0.2f, 0.3f)}};
    scene.lights = {{"", PointLight{dvec3(-0.5, 1.4, 0.5), vec3(0.4f, 0.3f, 0.2f)}},
                    {"", SpotLight{dvec3(0.2, 1.7, 0.8), dvec3(-0.1, -1, -0.3), vec3(1), {0.3f, 0.5f}}},
                    {"", DirectionalLight{dvec3(-1, -2, -0.5), vec3(0.3f, 0.3f, 0.4f)}}};
    expect_same_expectation(image(scene, EstimatorTest::settings(Estimator::light, 2), 256),
                            image(scene, EstimatorTest::settings(Estimator::mis, 1), 256));
}

TEST_F(PunctualLightTest, TheyShineThroughASheetFromBehind) {
    constexpr vec3 TRANSMITTANCE(0.25f, 0.5f, 0.75f);
    Scene scene = floor_under(PointLight{dvec3(0, -2, 0), INTENSITY});
    scene.materials[0].model = DiffuseTransmissionMaterial{vec3(0.1f), TRANSMITTANCE};
    const auto expect = [&](glm::dvec3 irradiance) {
        expect_mean(image_of(render(scene, settings(Estimator::mis), samples(64))),
                    glm::dvec3(TRANSMITTANCE) / M_PI * irradiance, 2e-4);
    };
    expect(point_irradiance(dvec3(0, 2, 0)));
    scene.lights = {{"", DirectionalLight{dvec3(0, 1, 1), INTENSITY}}};
    expect(glm::dvec3(INTENSITY) * std::sqrt(0.5));
}

TEST_F(PunctualLightTest, OpacityLetsItsShareThrough) {
    constexpr float OPACITY = 0.25f;
    for (const auto& light : {decltype(Light::model)(PointLight{dvec3(0, 2, 0), INTENSITY}),
                              decltype(Light::model)(DirectionalLight{dvec3(0, -1, 0), INTENSITY / 4.0f})}) {
        Scene scene = floor_under(light);
        const uint32_t veil = add_diffuse(scene, vec3(0));
        scene.materials[veil].opacity.value = OPACITY;
        add_shape(scene, parallelogram(vec3(-0.5f, 0.9f, -0.5f), vec3(1, 0, 0), vec3(0, 0, 1)), veil);
        expect_irradiance(scene, (1.0 - double(OPACITY)) * point_irradiance(dvec3(0, 2, 0)), 4096);
        scene.materials[veil].opacity.value = 1.0f;
        expect_black(scene);
    }
}

// Nothing else is behind a light at a point: what lies farther away does not hide it.
TEST_F(PunctualLightTest, ASurfaceBehindOrAtTheLightDoesNotHideIt) {
    for (const float height : {2.0f, 2.5f}) {
        Scene scene = floor_under(PointLight{dvec3(0, 2, 0), INTENSITY});
        add_shape(scene, parallelogram(vec3(-5, height, -5), vec3(10, 0, 0), vec3(0, 0, 10)),
                  add_diffuse(scene, vec3(0)));
        expect_irradiance(scene, point_irradiance(dvec3(0, 2, 0)));
    }
}

TEST_F(PunctualLightTest, AMirrorShowsNoneOfThem) {
    Scene scene = floor_under(PointLight{dvec3(0, 1, -5), INTENSITY});  // Where the camera's mirror image is.
    scene.lights.push_back({"", DirectionalLight{dvec3(0, -1, 5), INTENSITY}});
    scene.materials[0].model = MirrorMaterial{};
    expect_black(scene);
}

// A light on the floor itself, or just above: nothing is infinite. (Every sample must be finite: render()
// looks.)
TEST_F(PunctualLightTest, ALightOnTheSurfaceIsHarmless) {
    for (const double height : {0.0, 1e-8}) {
        render(floor_under(PointLight{dvec3(0, height, 0), INTENSITY}), settings(Estimator::mis), 16);
        render(floor_under(SpotLight{.position = dvec3(0, height, 0), .direction = dvec3(0, -1, 0)}),
               settings(Estimator::mis), 16);
    }
}

// Powers of two do not change anything except the choice of lights: the picture has the same digits, as long
// as the squares of samples are finite, and the digits that sums keep apart are no denormal numbers, which
// some devices flush.
TEST_F(PunctualLightTest, AnyIntensityMakesTheSamePicture) {
    const auto picture = [&](float factor) {
        Scene scene = floor_under(PointLight{dvec3(0, 2, 0), factor * INTENSITY});
        scene.lights.push_back({"", DirectionalLight{dvec3(0, -1, 1), factor * INTENSITY}});
        scene.lights.push_back({"", SpotLight{.position = dvec3(0, 2, 0),
                                              .direction = dvec3(0, -1, 0.5),
                                              .intensity = factor * INTENSITY}});
        return image_of(render(scene, settings(Estimator::mis), 16));
    };
    const Image one = picture(1.0f);
    for (const float factor : {0x1p-90f, 0x1p40f}) {
        const Image other = picture(factor);
        for (size_t c = 0; c < 3; ++c) {
            for (size_t i = 0; i < one.pixel_count(); ++i)
                ASSERT_EQ(plane(other, "", c)[i], factor * plane(one, "", c)[i]);
        }
    }
}

}  // namespace
}  // namespace candela
