// Sheets that scatter light diffusely to both sides: light samples reach either side, through the medium
// there.
#include <cmath>

#include "estimator_fixture.h"

namespace candela {
namespace {

constexpr float HALF_WIDTH = 60.0f;

// A horizontal sheet at that height, its front above.
void add_sheet(Scene& scene, float height, const DiffuseTransmissionMaterial& sheet) {
    add_shape(scene,
              parallelogram(vec3(-HALF_WIDTH, height, -HALF_WIDTH), vec3(0, 0, 2 * HALF_WIDTH),
                            vec3(2 * HALF_WIDTH, 0, 0)),
              add_material(scene, sheet));
}

class DiffuseTransmissionTest : public EstimatorTest {
  protected:
    // A camera that looks at the origin along the y axis, from above or from below; its rays are as good as
    // parallel.
    static Scene scene_seen_from(float height) {
        Scene scene = scene_with_camera(dvec3(0, height, 0), dvec3(0), 1e-3f);
        scene.cameras[0].up = vec3(0, 0, 1);
        return scene;
    }
    // Light of RADIANCE must reach the camera with that share. Roundings: a few vertices of some ten each.
    void expect_fraction(const Scene& scene, Estimator estimator, uint32_t spp, glm::dvec3 fraction) const {
        const Image image = image_of(render(scene, independent_settings(32, estimator, 4), samples(spp)));
        expect_mean(image, glm::dvec3(RADIANCE) * fraction, 1e-5);
    }
};

// A black lamp below the sheet that fills a cone around its normal: E / pi is the integral over x = sin^2(t)
// of what the medium lets through on the way to the lamp, d cos(t) - sqrt(r^2 - d^2 sin^2(t)).
TEST_F(DiffuseTransmissionTest, ALampBehindTheSheetShinesThroughIt) {
    constexpr double LAMP_RADIUS = 0.4, DISTANCE = 1.0;
    const vec3 transmittance(0.2f, 0.5f, 0.6f);
    for (const bool absorbs : {false, true}) {
        const glm::dvec3 absorption = absorbs ? glm::dvec3(ABSORPTION) : glm::dvec3(0);
        constexpr int POINTS = 10000;  // Points of the midpoint rule.
        constexpr double SIN2_MAX = LAMP_RADIUS * LAMP_RADIUS / (DISTANCE * DISTANCE);
        glm::dvec3 irradiance_over_pi(0.0);
        for (int i = 0; i < POINTS; ++i) {
            const double x = (i + 0.5) / POINTS * SIN2_MAX;
            const double way = DISTANCE * (std::sqrt(1.0 - x) - std::sqrt(SIN2_MAX - x));
            irradiance_over_pi += glm::exp(-absorption * way) * (SIN2_MAX / POINTS);
        }
        Scene scene = scene_seen_from(2);
        DiffuseTransmissionMaterial sheet{vec3(0.3f), transmittance};
        if (absorbs) sheet.inside = Medium{ABSORPTION};
        add_sheet(scene, 0, sheet);
        add_shape(scene, Sphere{dvec3(0, -DISTANCE, 0), LAMP_RADIUS}, add_diffuse(scene, vec3(0)),
                  Emission{RADIANCE, false});
        for (const Estimator estimator : ESTIMATORS) {
            SCOPED_TRACE(testing::Message() << int(estimator) << ' ' << absorbs);
            expect_fraction(scene, estimator, estimator == Estimator::bsdf ? 4096 : 512,
                            glm::dvec3(transmittance) * irradiance_over_pi);
        }
    }
}

// The same from the other side, and also with the lamp in front of the sheet.
TEST_F(DiffuseTransmissionTest, EitherSideIsLitByEither) {
    constexpr float LAMP_RADIUS = 0.7f;
    const vec3 reflectance(0.3f, 0.1f, 0.2f), transmittance(0.2f, 0.5f, 0.6f);
    for (const float camera : {2.0f, -2.0f}) {
        for (const float lamp : {1.0f, -1.0f}) {
            Scene scene = scene_seen_from(camera);
            add_sheet(scene, 0, {reflectance, transmittance});
            // Beside the camera's view: at 45 degrees.
            const dvec3 center(lamp, lamp, 0);
            add_shape(scene, Sphere{center, LAMP_RADIUS}, add_diffuse(scene, vec3(0)),
                      Emission{RADIANCE, false});
            const double irradiance_over_pi =
                std::sqrt(0.5) * double(LAMP_RADIUS) * double(LAMP_RADIUS) / 2.0;
            for (const Estimator estimator : ESTIMATORS) {
                SCOPED_TRACE(testing::Message() << int(estimator) << ' ' << camera << ' ' << lamp);
                expect_fraction(
                    scene, estimator, estimator == Estimator::bsdf ? 8192 : 512,
                    glm::dvec3(camera * lamp > 0 ? reflectance : transmittance) * irradiance_over_pi);
            }
        }
    }
}

// The integral of 2 exp(-sigma d / mu) mu over mu in [0, 1]: the transmittance of a medium between two planes
// of diffuse light.
glm::dvec3 diffuse_transmittance(double d) {
    constexpr int POINTS = 100000;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < POINTS; ++i) {
        const double mu = (i + 0.5) / POINTS;
        sum += glm::exp(-glm::dvec3(ABSORPTION) * (d / mu)) * (2.0 * mu / POINTS);
    }
    return sum;
}

// A sheet without a medium of its own stands in that of another: a path that crosses it stays there.
TEST_F(DiffuseTransmissionTest, ALeafWithinAMediumLeavesItAsItIs) {
    constexpr float DEPTH = 1.0f;
    Scene scene = scene_seen_from(2);
    add_sheet(scene, 0, {vec3(0), vec3(1), Medium{ABSORPTION}});
    add_sheet(scene, -DEPTH, {vec3(0), vec3(0.5f)});
    add_shape(scene,
              parallelogram(vec3(-HALF_WIDTH, -2 * DEPTH, -HALF_WIDTH), vec3(0, 0, 2 * HALF_WIDTH),
                            vec3(2 * HALF_WIDTH, 0, 0)),
              add_diffuse(scene, vec3(0)), Emission{RADIANCE, false});
    const glm::dvec3 layer = diffuse_transmittance(double(DEPTH));
    expect_fraction(scene, Estimator::bsdf, 1024, 0.5 * layer * layer);
}

// Nothing is lost: a ball of such a sheet cannot be seen under a constant sky.
TEST_F(DiffuseTransmissionTest, ALosslessBallIsInvisible) {
    Scene scene = scene_with_camera(dvec3(1, 2, 4.5), dvec3(0), 0.4f);
    scene.environment = constant_environment(vec3(1));
    add_shape(scene, Sphere{}, add_material(scene, DiffuseTransmissionMaterial{vec3(0.25f), vec3(0.75f)}));
    for (const Estimator estimator : ESTIMATORS) {
        const Image image = image_of(render(scene, independent_settings(32, estimator, 5), samples(512)));
        expect_mean(image, glm::dvec3(1.0), 0x1p-16);
    }
}

// A lamp within a shade, a smooth mesh whose shading normals see what its triangles do not, and a sky.
TEST_F(DiffuseTransmissionTest, EstimatorsAgreeOnALampWithinItsShade) {
    Scene scene = open_room();
    scene.environment = one_bright_texel({8, 4}, {4, 1}, vec3(5, 4, 3));
    const uint32_t shade =
        add_material(scene, DiffuseTransmissionMaterial{vec3(0.3f, 0.2f, 0.1f), vec3(0.6f, 0.5f, 0.4f)});
    add_shape(scene, Sphere{dvec3(-0.7, 0.8, 0), 0.5}, shade);
    add_shape(scene, Sphere{dvec3(-0.7, 0.8, 0), 0.2}, 0, Emission{vec3(4, 3, 2), false});
    TriangleMesh ball = sphere_mesh(6, 9);
    ball.normals = ball.positions;
    add_shape(scene, transformed(ball, [](vec3 p) { return vec3(0.7f, 0.6f, 0) + 0.5f * p; }), shade);
    expect_estimators_agree(scene, 1024, 1024);
}

}  // namespace
}  // namespace candela
