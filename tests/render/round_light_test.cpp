// Direct light of spheres and disks has closed forms.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

class RoundLightTest : public RenderTest {
  protected:
    static RenderSettings settings(Estimator estimator) {
        RenderSettings s = independent_settings(32, estimator, 1);
        s.max_depth = 1;
        return s;
    }
    // The floor at the origin must reflect what `form_factor` of the light's radiance gives; samples per
    // pixel for light samples (and MIS) and for BSDF samples, or 0 where one would need too many. The camera
    // sees 13 mm of the floor to either side, over which the irradiance changes linearly, which cancels, and
    // in second order by (13 mm / 1 m)^2 of itself, for lights at 1 m or more; a third of that on average.
    void expect_form_factor(const Scene& scene, double form_factor, uint32_t light_spp,
                            uint32_t bsdf_spp) const {
        const glm::dvec3 expected = glm::dvec3(REFLECTANCE) * glm::dvec3(RADIANCE) * form_factor;
        const auto test = [&](Estimator estimator, uint32_t spp) {
            SCOPED_TRACE(int(estimator));
            if (spp > 0)
                expect_mean(image_of(render(scene, settings(estimator), samples(spp))), expected, 6e-5);
        };
        test(Estimator::light, light_spp);
        test(Estimator::mis, light_spp);
        test(Estimator::bsdf, bsdf_spp);
    }
    static Scene floor_under(const decltype(Shape::geometry)& light, bool two_sided = false) {
        Scene scene = floor_seen_closely(REFLECTANCE);
        add_shape(scene, light, 1, Emission{RADIANCE, two_sided});
        return scene;
    }
    // Direction to the left, at that angle from the floor's normal [degrees].
    static dvec3 direction(double theta) {
        return dvec3(-std::sin(theta * M_PI / 180.0), std::cos(theta * M_PI / 180.0), 0);
    }
};

// Above the horizon, a sphere lights a surface as a point of the same intensity does: (r / d)^2 cos(theta).
// Ref: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-38.
TEST_F(RoundLightTest, ASphereAboveTheHorizon) {
    struct Case {
        double radius, distance, theta;
        uint32_t light_spp, bsdf_spp;
    };
    for (const Case c : {Case{0.5, 2.0, 0.0, 64, 4096}, Case{1.9, 2.0, 0.0, 1024, 128},
                         Case{1.0, 2.0, 45.0, 256, 2048}, Case{0.01, 3.0, 60.0, 16, 0}}) {
        SCOPED_TRACE(testing::Message() << "radius " << c.radius << " at " << c.distance << " m");
        const dvec3 center = c.distance * direction(c.theta);
        const double ratio = c.radius / c.distance;
        expect_form_factor(floor_under(Sphere{center, c.radius}),
                           ratio * ratio * std::cos(c.theta * M_PI / 180.0), c.light_spp, c.bsdf_spp);
    }
}

// Half of the sphere is below the floor: the form factor of a cap that the horizon cuts in half, for a point
// in the plane of its centre.
// Ref: Howell, B-38 with the sphere's centre in the plane of the element: (asin(r/d) - (r/d) sqrt(1 -
// (r/d)^2)) / pi.
TEST_F(RoundLightTest, ASphereThatTheFloorCuts) {
    const double s = 0.9;
    const double form_factor = (std::asin(s) - s * std::sqrt(1.0 - s * s)) / M_PI;
    expect_form_factor(floor_under(Sphere{dvec3(-2, 0, 0), 1.8}), form_factor, 2048, 2048);
}

// From within, a sphere fills the sky, if it shines inwards.
TEST_F(RoundLightTest, ASphereAroundTheFloor) {
    for (const bool two_sided : {false, true}) {
        Scene scene = floor_under(Sphere{dvec3(0.5, 1, 0.3), 20.0}, two_sided);
        scene.shapes[0].geometry = Disk{dvec3(0), dvec3(0, 0, 9), dvec3(9, 0, 0)};
        expect_form_factor(scene, two_sided ? 1.0 : 0.0, 1024, 16);
    }
}

TEST_F(RoundLightTest, SpheresOfDifferentPowerAddUp) {
    Scene scene = floor_under(Sphere{dvec3(-1.5, 2, 0), 0.5});
    add_shape(scene, Sphere{dvec3(2, 1.5, 0), 0.1}, 1, Emission{9.0f * RADIANCE, true});
    const double d3 = std::pow(2.5, 3.0);
    expect_form_factor(scene, 0.25 * 2.0 / d3 + 9.0 * 0.01 * 1.5 / d3, 256, 0);
}

TEST_F(RoundLightTest, ASphereCastsAFullShadow) {
    Scene scene = floor_under(Sphere{dvec3(0, 3, 0), 0.2});
    add_shape(scene, Sphere{dvec3(0, 1.5, 0), 0.5}, 1);
    expect_form_factor(scene, 0.0, 64, 64);
}

// r^2 / (r^2 + d^2) on the axis. Ref: Howell, B-12.
TEST_F(RoundLightTest, ADiskOnItsAxis) {
    struct Case {
        double radius, height;
        uint32_t light_spp, bsdf_spp;
    };
    for (const Case c : {Case{1.0, 2.0, 256, 2048}, Case{4.0, 1.0, 2048, 64}, Case{0.02, 2.0, 16, 0}}) {
        SCOPED_TRACE(testing::Message() << "radius " << c.radius << " at " << c.height << " m");
        const double r2 = c.radius * c.radius;
        const double form_factor = r2 / (r2 + c.height * c.height);
        const Disk down{dvec3(0, c.height, 0), dvec3(c.radius, 0, 0), dvec3(0, 0, c.radius)};
        expect_form_factor(floor_under(down), form_factor, c.light_spp, c.bsdf_spp);
        const Disk up{down.center, down.e2, down.e1};
        expect_form_factor(floor_under(up), 0.0, 16, 16);
        expect_form_factor(floor_under(up, true), form_factor, c.light_spp, c.bsdf_spp);
    }
}

// A small ellipse that faces the origin: area / (pi d^2) times the floor's cosine. Its own extent changes
// that by no more than (0.01 / 2)^2 of itself.
TEST_F(RoundLightTest, AnEllipseAcrossTheView) {
    const dvec3 n = -direction(50.0);
    const dvec3 e1(0, 0, 0.01);
    const dvec3 e2 = 0.005 * cross(n, dvec3(0, 0, 1));
    ASSERT_GT(dot(cross(e1, e2), n), 0.0);
    const double area_over_pi = 0.01 * 0.005;
    expect_form_factor(floor_under(Disk{-2.0 * n, e1, e2}),
                       area_over_pi / 4.0 * std::cos(50.0 * M_PI / 180.0), 64, 0);
}

// What a camera sees is the light's radiance, on the front only.
TEST_F(RoundLightTest, ALightThatIsLookedAtShowsItsRadiance) {
    Scene scene = scene_with_camera(dvec3(0, 0, 3), dvec3(0), 0.1f);
    add_diffuse(scene, vec3(0));
    const Disk front{dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)};
    const Disk back{dvec3(0), dvec3(0, 1, 0), dvec3(1, 0, 0)};
    const Sphere outside{dvec3(0), 1.0};
    const Sphere inside{dvec3(0), 9.0};
    const auto seen = [&](const decltype(Shape::geometry)& light, bool two_sided) {
        scene.shapes.clear();
        add_shape(scene, light, 0, Emission{RADIANCE, two_sided});
        return image_of(render(scene, settings(Estimator::mis), 4));
    };
    expect_pixels(seen(front, false), RADIANCE);
    expect_pixels(seen(back, false), vec3(0));
    expect_pixels(seen(back, true), RADIANCE);
    expect_pixels(seen(outside, false), RADIANCE);
    expect_pixels(seen(inside, false), vec3(0));
    expect_pixels(seen(inside, true), RADIANCE);
}

// A veil that half of the rays pass: three quarters of those towards it meet it on one side or the other,
// for every estimator.
TEST_F(RoundLightTest, ASphereThatRaysMayPassShinesFromItsFarSide) {
    Scene scene = floor_under(Sphere{dvec3(0, 2, 0), 1.0}, true);
    scene.materials.push_back(scene.materials[1]);
    scene.materials.back().opacity.value = 0.5f;
    scene.shapes.back().material = uint32_t(scene.materials.size() - 1);
    expect_form_factor(scene, 0.25 * 0.75, 2048, 2048);
}

// Within a dome, light is sampled on all of it, though rounding puts points of it outside.
TEST_F(RoundLightTest, ADomeLightsItself) {
    for (const Estimator estimator : {Estimator::light, Estimator::mis, Estimator::bsdf}) {
        SCOPED_TRACE(int(estimator));
        Scene scene = scene_with_camera(dvec3(0.1, 0.2, 0), dvec3(0, 0, -1), 0.5f);
        add_shape(scene, Sphere{dvec3(0), 1.0}, add_diffuse(scene, vec3(0.5f)), Emission{vec3(1), true});
        // Something is lit from behind, so that points lie on surfaces themselves.
        add_shape(scene, Disk{dvec3(0, 0, 0.9), dvec3(0.01, 0, 0), dvec3(0, 0.01, 0)},
                  add_material(scene, DiffuseTransmissionMaterial{vec3(0.5f), vec3(0.5f), {}}));
        RenderSettings s = independent_settings(32, estimator, 3);
        s.max_depth = 1;
        expect_mean(image_of(render(scene, s, samples(256))), glm::dvec3(1.5), 1e-4);
    }
}

}  // namespace
}  // namespace candela
