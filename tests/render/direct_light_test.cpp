// Direct light has closed forms: what a Lambert surface reflects under a parallel rectangle, and who lights
// whom.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

// Form factor from a surface element to a parallel rectangle a x b at height h, one of whose corners is
// straight above. Ref: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3.
double corner_form_factor(double a, double b, double h) {
    const double x = a / h, y = b / h;
    const double rx = std::sqrt(1.0 + x * x), ry = std::sqrt(1.0 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2.0 * M_PI);
}

// A rectangle over the floor that faces down, or up.
Shape lamp(float x0, float x1, float z0, float z1, float height, bool down = true, bool two_sided = false) {
    const vec3 e1(x1 - x0, 0, 0), e2(0, 0, z1 - z0);
    return {.geometry = parallelogram(vec3(x0, height, z0), down ? e1 : e2, down ? e2 : e1),
            .material = 1,
            .emission = Emission{.radiance = RADIANCE, .two_sided = two_sided}};
}

class DirectLightTest : public RenderTest {
  protected:
    static RenderSettings settings(Estimator estimator) {
        RenderSettings s = independent_settings(16, estimator, 0);
        s.max_depth = 1;
        return s;
    }
    // The camera sees 7 mm of a floor 1 m or more from the lamps: irradiance changes by (7 mm / 1 m)^2 at
    // most around an extremum, and elsewhere linearly, which cancels over the pixels; 5e-5 in sum.
    void expect_radiance(const Scene& scene, Estimator estimator, uint32_t spp, double form_factor) const {
        const glm::dvec3 expected = glm::dvec3(REFLECTANCE) * glm::dvec3(RADIANCE) * form_factor;
        expect_mean(image_of(render(scene, settings(estimator), samples(spp))), expected, 5e-5);
    }
    void expect_black(const Scene& scene) const {
        for (const Estimator estimator : {Estimator::bsdf, Estimator::light, Estimator::mis}) {
            expect_pixels(image_of(render(scene, settings(estimator), 16)), vec3(0));
        }
    }
};

TEST_F(DirectLightTest, UnderTheCentreOfARectangle) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes.push_back(lamp(-1, 1, -0.5f, 0.5f, 2));
    const double form_factor = 4.0 * corner_form_factor(1, 0.5, 2);
    expect_radiance(scene, Estimator::light, 512, form_factor);
    expect_radiance(scene, Estimator::mis, 512, form_factor);
    expect_radiance(scene, Estimator::bsdf, 16384, form_factor);
}

TEST_F(DirectLightTest, UnderACornerOfALargeRectangle) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes.push_back(lamp(0, 6, -4, 0, 1.5f));
    const double form_factor = corner_form_factor(6, 4, 1.5);
    expect_radiance(scene, Estimator::light, 8192, form_factor);
    expect_radiance(scene, Estimator::mis, 2048, form_factor);
    expect_radiance(scene, Estimator::bsdf, 4096, form_factor);
}

// Two lamps of different size: errors of the choice between them do not cancel. Neither hides the other from
// the origin.
TEST_F(DirectLightTest, TwoLampsAddUp) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes.push_back(lamp(0, 0.3f, 0, 0.3f, 2));
    scene.shapes.push_back(lamp(-3, 0, -3, 0, 1, true, true));
    const double form_factor = corner_form_factor(0.3, 0.3, 2) + corner_form_factor(3, 3, 1);
    expect_radiance(scene, Estimator::light, 4096, form_factor);
    expect_radiance(scene, Estimator::mis, 2048, form_factor);
}

TEST_F(DirectLightTest, TheBackOfALampIsDark) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes.push_back(lamp(-1, 1, -1, 1, 2, false));
    expect_black(scene);
    scene.shapes.back() = lamp(-1, 1, -1, 1, 2, false, true);
    expect_radiance(scene, Estimator::mis, 512, 4.0 * corner_form_factor(1, 1, 2));
}

// The floor's winding does not matter: opaque surfaces reflect on both sides.
TEST_F(DirectLightTest, BothSidesOfASurfaceReflect) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes[0].geometry = parallelogram(vec3(-50, 0, 50), vec3(0, 0, -100), vec3(100, 0, 0));
    scene.shapes.push_back(lamp(-1, 1, -1, 1, 2));
    expect_radiance(scene, Estimator::mis, 512, 4.0 * corner_form_factor(1, 1, 2));
    expect_radiance(scene, Estimator::light, 512, 4.0 * corner_form_factor(1, 1, 2));
}

// No light comes through the floor from a lamp below it.
TEST_F(DirectLightTest, ASurfaceIsOpaque) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes.push_back(lamp(-1, 1, -1, 1, -2, false));
    expect_black(scene);
}

TEST_F(DirectLightTest, ABlockerCastsAFullShadow) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes.push_back(lamp(-1, 1, -1, 1, 2));
    Shape blocker = lamp(-2, 2, -2, 2, 1.5f);
    blocker.emission.reset();
    scene.shapes.push_back(blocker);
    expect_black(scene);
}

TEST_F(DirectLightTest, AScreenThatIsLookedAtShowsItsRadianceOnTheFrontOnly) {
    Scene scene = scene_with_camera(dvec3(0, 0, 2), dvec3(0), 0.5f);
    add_diffuse(scene, vec3(0));
    for (const bool front : {true, false}) {
        const vec3 e1(2, 0, 0), e2(0, 2, 0);
        scene.shapes = {{.geometry = parallelogram(vec3(-1, -1, 0), front ? e1 : e2, front ? e2 : e1),
                         .material = 0,
                         .emission = Emission{.radiance = RADIANCE, .two_sided = false}}};
        const Image image = image_of(render(scene, settings(Estimator::mis), 4));
        expect_pixels(image, front ? RADIANCE : vec3(0));
        EXPECT_EQ(coverage(image), 1.0);
    }
}

TEST_F(DirectLightTest, ASceneWithoutLightsIsBlack) {
    expect_black(floor_seen_closely(REFLECTANCE));
}

TEST_F(DirectLightTest, ASceneWithoutShapesIsBlackAndTransparent) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.shapes.clear();
    expect_black(scene);
    EXPECT_EQ(coverage(image_of(render(scene, settings(Estimator::mis), 4))), 0.0);
}

}  // namespace
}  // namespace candela
