// The sky: where its texels lie, how they light a surface, and who sees it.
#include <cmath>

#include "render_fixture.h"
#include "scene/sky.h"

namespace candela {
namespace {

class EnvironmentLightTest : public RenderTest {
  protected:
    static RenderSettings settings(Estimator estimator) {
        RenderSettings s = independent_settings(32, estimator, 1);
        s.max_depth = 1;
        return s;
    }
    static Scene floor_under(Environment environment) {
        Scene scene = floor_seen_closely(REFLECTANCE);
        scene.environment = std::move(environment);
        return scene;
    }
    // A surface must reflect what `form_factor` of the texels' radiance gives; samples per pixel for light
    // samples (and MIS) and for BSDF samples. Directions are rounded at 2^-22: an edge of a texel may be off
    // by that, while the texels below are a tenth of a radian wide or more.
    void expect_form_factor(const Scene& scene, double form_factor, uint32_t light_spp,
                            uint32_t bsdf_spp) const {
        const glm::dvec3 expected = glm::dvec3(REFLECTANCE) * glm::dvec3(RADIANCE) * form_factor;
        for (const Estimator estimator : {Estimator::light, Estimator::mis, Estimator::bsdf}) {
            SCOPED_TRACE(int(estimator));
            const uint32_t spp = estimator == Estimator::bsdf ? bsdf_spp : light_spp;
            expect_mean(image_of(render(scene, settings(estimator), samples(spp))), expected, 1e-5);
        }
    }
};

TEST_F(EnvironmentLightTest, AConstantSkyLightsAFloorWithPi) {
    expect_form_factor(floor_under(constant_environment(RADIANCE)), 1.0, 1024, 16);
}

TEST_F(EnvironmentLightTest, TheUpperHalfLightsAFloorAndTheLowerDoesNot) {
    Environment halves{.size = {1, 2}, .radiance = {RADIANCE, vec3(0)}};
    expect_form_factor(floor_under(halves), 1.0, 1024, 16);
    std::swap(halves.radiance[0], halves.radiance[1]);
    expect_form_factor(floor_under(halves), 0.0, 16, 16);
}

TEST_F(EnvironmentLightTest, TheRightHalfLightsAFloorWithHalf) {
    expect_form_factor(floor_under({.size = {2, 1}, .radiance = {vec3(0), RADIANCE}}), 0.5, 2048, 1024);
}

// A floor reflects the integral of the sky above, over texels: sum of radiance * (sin^2 theta_1 - sin^2
// theta_0) / width. The sun, three texels wide, gives most of it: an edge that is off by 2^-22 changes it by
// 2^-13.
TEST_F(EnvironmentLightTest, AClearSkyLightsAFloor) {
    const Environment sky = sky_environment({.sun_elevation = 0.6, .sun_azimuth = 2.0});
    dvec3 paper(0.0);
    for (uint32_t y = 0; y < sky.size.y / 2; ++y) {
        const double s0 = std::sin(y * M_PI / sky.size.y), s1 = std::sin((y + 1) * M_PI / sky.size.y);
        for (uint32_t x = 0; x < sky.size.x; ++x)
            paper += (s1 * s1 - s0 * s0) / sky.size.x * dvec3(sky.radiance[size_t{y} * sky.size.x + x]);
    }
    const Scene scene = floor_under(sky);
    for (const Estimator estimator : {Estimator::light, Estimator::mis})
        expect_mean(image_of(render(scene, settings(estimator), samples(256))), dvec3(REFLECTANCE) * paper,
                    0x1p-13);
}

// Integral of cos(theta) / pi over a texel of a map of 8 x 4: (sin^2(theta_1) - sin^2(theta_0)) / 8.
TEST_F(EnvironmentLightTest, OneBrightTexelLightsAFloor) {
    for (const uint32_t row : {0u, 1u}) {
        SCOPED_TRACE(row);
        const double s0 = std::sin(row * M_PI / 4.0), s1 = std::sin((row + 1) * M_PI / 4.0);
        const Scene scene = floor_under(one_bright_texel({8, 4}, {5, row}, RADIANCE));
        expect_form_factor(scene, (s1 * s1 - s0 * s0) / 8.0, 256, 4096);
    }
}

// On a wall that faces -Z, the map's centre: the integral of sin^2(theta) over rows times that of cos(phi)
// over columns, over pi. A turn of the sky about +Y takes the columns along, to the left and partly behind
// the wall.
TEST_F(EnvironmentLightTest, RotationMovesTheLight) {
    constexpr uint32_t COLUMNS = 8;
    for (const uint32_t column : {4u, 5u}) {
        for (const float degrees : {0.0f, 30.0f, -5.0f}) {
            SCOPED_TRACE(testing::Message() << "column " << column << " turned by " << degrees);
            Scene scene = floor_under(one_bright_texel({COLUMNS, 4}, {column, 1}, RADIANCE));
            scene.environment->rotation = float(degrees * DEGREE);
            scene.cameras[0].position = dvec3(0, 1, -5);
            scene.shapes[0].geometry = parallelogram(vec3(-50, -50, 0), vec3(0, 100, 0), vec3(100, 0, 0));
            const double rows = M_PI / 8.0 + 0.25;  // From 45 to 90 degrees.
            // Longitude from -Z to the right, +X.
            const double phi0 = (column / double(COLUMNS) - 0.5) * 2.0 * M_PI - double(degrees) * DEGREE;
            const double phi1 = std::min(0.5 * M_PI, phi0 + 2.0 * M_PI / COLUMNS);
            const double columns = std::sin(phi1) - std::sin(phi0);
            expect_form_factor(scene, rows * columns / M_PI, 512, 6144);
        }
    }
}

// The camera looks along each axis at a texel of its own: -X -Z +X in the map's middle, up and down at its
// ends.
TEST_F(EnvironmentLightTest, TheMapSurroundsTheScene) {
    Environment map{.size = {4, 3}, .radiance = std::vector<vec3>(12)};
    for (size_t i = 0; i < 12; ++i)
        map.radiance[i] = vec3(float(i), 1, 2);
    const auto seen = [&](vec3 direction, float rotation) {
        // A column of the map spans 90 degrees from -180; the views are off the axes, which lie on edges.
        Scene scene = scene_with_camera(dvec3(0), dvec3(direction), 0.2f);
        scene.environment = map;
        scene.environment->rotation = rotation;
        return image_of(render(scene, settings(Estimator::mis), 1));
    };
    const float aside = 0.7f;  // Towards the middle of a column.
    expect_pixels(seen(vec3(-aside, 0, -1), 0), map.radiance[5]);
    expect_pixels(seen(vec3(aside, 0, -1), 0), map.radiance[6]);
    expect_pixels(seen(vec3(aside, 0, 1), 0), map.radiance[7]);
    expect_pixels(seen(vec3(-aside, 0, 1), 0), map.radiance[4]);
    expect_pixels(seen(vec3(0.3f, 1, -0.3f), 0), map.radiance[2]);
    expect_pixels(seen(vec3(0.3f, -1, 0.3f), 0), map.radiance[11]);
    // Turned counter-clockwise as seen from above by 90 degrees, the centre, -Z, comes to lie at -X.
    expect_pixels(seen(vec3(-1, 0, -aside), 0.5f * PI), map.radiance[6]);
    expect_pixels(seen(vec3(-1, 0, aside), 0.5f * PI), map.radiance[5]);
}

// A floor that fills the left half of the picture.
TEST_F(EnvironmentLightTest, AHiddenSkyIsTransparentAndLightsAllTheSame) {
    Scene scene = scene_with_camera(dvec3(0, 0, 3), dvec3(0), 0.5f);
    add_diffuse(scene, REFLECTANCE);
    add_shape(scene, parallelogram(vec3(-9, -9, 0), vec3(9, 0, 0), vec3(0, 18, 0)), 0);
    for (const bool visible : {true, false}) {
        scene.environment = constant_environment(RADIANCE);
        scene.environment->visible = visible;
        const Image image = image_of(render(scene, settings(Estimator::bsdf), 4));
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const bool covered = i % 32 < 16;
            ASSERT_EQ(image.find("A")->values[i], covered || visible ? 1.0f : 0.0f);
            for (int c = 0; c < 3; ++c) {
                const float sky = visible ? RADIANCE[c] : 0.0f;
                ASSERT_FLOAT_EQ(plane(image, "", size_t(c))[i], covered ? REFLECTANCE[c] * RADIANCE[c] : sky);
            }
        }
    }
}

TEST_F(EnvironmentLightTest, AHiddenSkyShowsInAMirror) {
    Scene scene = scene_with_camera(dvec3(0, 0, 3), dvec3(0), 0.5f);
    add_shape(scene, parallelogram(vec3(-9, -9, 0), vec3(18, 0, 0), vec3(0, 18, 0)),
              add_material(scene, MirrorMaterial{}));
    scene.environment = constant_environment(RADIANCE);
    scene.environment->visible = false;
    expect_pixels(image_of(render(scene, settings(Estimator::mis), 4)), RADIANCE);
}

// Neither a black sky nor a scene with only a sky divides by zero.
TEST_F(EnvironmentLightTest, ABlackSkyAndAnEmptySceneAreRendered) {
    expect_form_factor(floor_under(constant_environment(vec3(0))), 0.0, 4, 4);
    Scene empty = floor_under(constant_environment(RADIANCE));
    empty.shapes.clear();
    const Image image = image_of(render(empty, settings(Estimator::mis), 4));
    expect_pixels(image, RADIANCE);
    EXPECT_EQ(coverage(image), 1.0);
}

TEST_F(EnvironmentLightTest, TheSkyAndALampAddUp) {
    Scene scene = floor_under(constant_environment(RADIANCE));
    // A floor of the lamp's size, as the sky's share of the samples grows with the scene.
    scene.shapes[0].geometry = Disk{dvec3(0), dvec3(0, 0, 1), dvec3(1, 0, 0)};
    // Twenty times as bright as the part of the sky that it hides.
    add_shape(scene, Sphere{dvec3(0, 2, 0), 0.5}, 1, Emission{20.0f * RADIANCE, false});
    expect_form_factor(scene, 1.0 + 19.0 / 16.0, 2048, 4096);
}

}  // namespace
}  // namespace candela
