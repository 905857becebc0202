// Surfaces that emit close to their normal, and spheres that emit in a cone.
#include <cmath>

#include "estimator_fixture.h"

namespace candela {
namespace {

using BeamTest = EstimatorTest;

RenderSettings direct(Estimator estimator) {
    RenderSettings settings = independent_settings(32, estimator, 1);
    settings.max_depth = 1;
    return settings;
}

// A floor at the origin, seen closely (see RoundLightTest), and the light, which has the beam.
Scene floor_under(const Geometry& light, const Beam& beam, bool two_sided = false) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    add_shape(scene, light, 1, Emission{RADIANCE, two_sided});
    scene.shapes.back().beam = beam;
    return scene;
}

class FormFactorTest : public RenderTest {
  protected:
    void expect_form_factor(const Scene& scene, double form_factor) const {
        for (const Estimator estimator : ESTIMATORS) {
            SCOPED_TRACE(int(estimator));
            const uint32_t spp = estimator == Estimator::bsdf ? 5120 : 1024;
            expect_mean(image_of(render(scene, direct(estimator), samples(spp))),
                        form_factor * glm::dvec3(REFLECTANCE) * glm::dvec3(RADIANCE), 6e-5);
        }
    }
};

// On the axis of a disk, light comes from all angles a up to that of its edge, or of the beam:
// 2 int sin(a) cos(a) (1 - tan(a) / T) da, T being the tangent of half the spread.
TEST_F(FormFactorTest, OfADiskWithASpread) {
    for (const double degrees : {60.0, 90.0, 150.0}) {
        for (const bool behind : {false, true}) {
            SCOPED_TRACE(testing::Message() << degrees << " degrees, behind: " << behind);
            const double half = 0.5 * degrees * DEGREE;
            const double a = std::min(half, std::atan(1.5 / 2.0));
            const double form_factor =
                std::sin(a) * std::sin(a) - (a - std::sin(a) * std::cos(a)) / std::tan(half);
            const dvec3 e1(1.5, 0, 0), e2(0, 0, 1.5);
            const Disk light{dvec3(0, 2, 0), behind ? e2 : e1, behind ? e1 : e2};
            expect_form_factor(floor_under(light, {.spread = float(2.0 * half)}, behind), form_factor);
        }
    }
}

// A sphere above the floor whose cone points down: light that comes at the angle a to the floor's normal left
// at that angle to the axis. With c = cos(a), the integral of t^2 or t^2 (3 - 2t) times c over the falloff,
// where t is linear in c, and of c within.
TEST_F(FormFactorTest, OfASphereWithACone) {
    const double inner = std::cos(15.0 * DEGREE), outer = std::cos(35.0 * DEGREE), width = inner - outer;
    for (const SpotFalloff falloff : {SpotFalloff::square, SpotFalloff::smoothstep}) {
        const double edge = falloff == SpotFalloff::square ? outer / 3.0 + width / 4.0
                                                           : outer / 2.0 + width * (3.0 / 4.0 - 2.0 / 5.0);
        const Cone cone{float(15.0 * DEGREE), float(35.0 * DEGREE), falloff};
        const Sphere light{dvec3(0, 2, 0), 1.5, dvec3(0, -3, 0)};
        expect_form_factor(floor_under(light, {.cone = cone}), 1.0 - inner * inner + 2.0 * width * edge);
    }
}

TEST_F(FormFactorTest, OfASphereWhoseConePointsAwayIsZero) {
    Scene scene = floor_under(Sphere{dvec3(0, 2, 0), 1.5, dvec3(0, 1, 0)}, {.cone = Cone{}});
    for (const Estimator estimator : ESTIMATORS)
        expect_pixels(image_of(render(scene, direct(estimator), 4)), vec3(0.0f));
}

// From afar, a sphere with a cone is a spot.
TEST_F(BeamTest, ASmallSphereIsASpot) {
    constexpr double RADIUS = 0.01;
    const Cone cone{0.2f, 0.5f};
    const dvec3 place(1, 2, -0.5), axis(-0.6, -2, 0.9);  // Mirrored in any way, it misses the floor.
    const Scene soft = floor_under(Sphere{place, RADIUS, axis}, {.cone = cone});
    Scene hard = floor_seen_closely(REFLECTANCE);
    hard.lights = {{"", SpotLight{place, axis, vec3(glm::dvec3(RADIANCE) * M_PI * RADIUS * RADIUS), cone}}};
    const Image spot = image_of(render(hard, direct(Estimator::light), samples(256)));
    glm::dvec3 expected;
    for (size_t c = 0; c < 3; ++c)
        expected[int(c)] = image_mean(spot, c).mean;
    // The falloff's curvature over the sphere.
    expect_mean(image_of(render(soft, direct(Estimator::mis), samples(256))), expected, 3e-4);
}

// In a room: a parallelogram with a glowing image, a quad that is none, under a coat, a lamp with two sides,
// and spheres with a cone and with a spread.
TEST_F(BeamTest, EstimatorsAgree) {
    Scene scene = open_room();
    const uint32_t grey = 0;
    const Texture image = add_texture(scene, {2, 2}, [](uint32_t x, uint32_t y) {
        return vec4(x == y ? 2.0f : 0.2f, 1.0f, x == 0 ? 0.5f : 1.0f, 1.0f);
    });
    const uint32_t coated = add_material(
        scene, PrincipledMaterial{.base_color = vec3(0.3f), .coat = 1.0f, .coat_roughness = 0.2f});
    const auto add = [&](const Geometry& geometry, uint32_t material, const Emission& emission,
                         const Beam& beam) {
        add_shape(scene, geometry, material, emission);
        scene.shapes.back().beam = beam;
    };
    add(parallelogram(vec3(-1, 1.99f, -1), vec3(0.8f, 0, 0), vec3(0, 0, 0.8f)), grey,
        {{vec3(9), image}, false}, {.spread = 1.5f});
    add(Quad{{dvec3(0.5, 1.9, -1), dvec3(1.5, 1.9, -1.2), dvec3(1.2, 1.9, 0), dvec3(0.6, 1.9, -0.2)}}, coated,
        {vec3(2, 4, 6), false}, {.spread = 2.2f});
    add(parallelogram(vec3(-1.5f, 0.5f, -1), vec3(0.8f, 0, 0.3f), vec3(0, 0.9f, 0)), grey, {vec3(3), true},
        {.spread = 2.5f});
    add(Sphere{dvec3(0.6, 0.7, 0.1), 0.3, dvec3(-1, -1, 0.2)}, coated, {vec3(6, 2, 2), false},
        {.cone = Cone{0.3f, 0.9f, SpotFalloff::smoothstep}});
    add(Sphere{dvec3(-0.4, 0.3, 0.3), 0.1, dvec3(1, 0.3, -1)}, grey, {vec3(8), false}, {.spread = 2.0f});
    expect_estimators_agree(scene, 512, 256);
}

}  // namespace
}  // namespace candela
