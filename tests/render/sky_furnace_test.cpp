// Under a constant sky a body that loses nothing cannot be seen, and any other shows its albedo, which is
// known from quadrature on the host.
#include <cmath>
#include <functional>

#include "render_fixture.h"

namespace candela {
namespace {

class SkyFurnaceTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 32;

    // A unit sphere that fills most of the picture, seen against a sky of radiance 1.
    template <class Model>
    static Scene sphere_of(const Model& model) {
        Scene scene = scene_with_camera(dvec3(1, 2, 4.5), dvec3(0), 0.4f);
        scene.environment = constant_environment(vec3(1));
        add_shape(scene, Sphere{}, add_material(scene, model));
        return scene;
    }
    // Every sample must be 1 but for rounding. Where a device is as coarse as Vulkan allows, a vertex in
    // glass costs some 28 units of 2^-24: the medium's transmittance, the exponential of 0, is off by 3 ulp
    // (6 units), each of the divisions by eta, by its square and of its inverse by 2.5 (5 units, twice where
    // it is squared). Paths of up to 9 vertices: 2^-16.
    void expect_invisible(const Scene& scene, const RenderSettings& settings) const {
        const Image image = image_of(render(scene, settings, 16));
        EXPECT_EQ(coverage(image), 1.0);
        for (size_t c = 0; c < 3; ++c) {
            for (const float value : plane(image, "", c))
                ASSERT_NEAR(value, 1.0f, 0x1p-16);
        }
    }
    // The mean over the image must be 1 within its noise; roulette and light samples have some.
    void expect_invisible_on_average(const Scene& scene, const RenderSettings& settings, uint32_t spp) const {
        const Image image = image_of(render(scene, settings, spp));
        expect_mean(image, glm::dvec3(1.0),
                    0x1p-18);  // Paths of some ten vertices, each rounds some ten times.
    }
    static RenderSettings settings(Estimator estimator, uint32_t seed) {
        return independent_settings(SIZE, estimator, seed);
    }
    static RenderSettings without_roulette(Estimator estimator, uint32_t seed) {
        RenderSettings s = settings(estimator, seed);
        s.rr_depth = DEPTH_SAFETY_LIMIT;
        return s;
    }
};

TEST_F(SkyFurnaceTest, AnIdealMirrorIsInvisible) {
    for (const Estimator estimator : ESTIMATORS)
        expect_invisible(sphere_of(MirrorMaterial{vec3(1)}), without_roulette(estimator, 1));
}

TEST_F(SkyFurnaceTest, ClearGlassIsInvisible) {
    for (const Fresnel fresnel : {Fresnel::schlick, Fresnel::exact}) {
        for (const float ior : {1.5f, 2.4f, 0.7f}) {
            SCOPED_TRACE(testing::Message() << int(fresnel) << ' ' << ior);
            const Scene scene = sphere_of(DielectricMaterial{.ior = ior, .fresnel = fresnel});
            expect_invisible(scene, without_roulette(Estimator::mis, 2));
            // Paths that are caught in the glass are few and carry much: fewer samples would not show the
            // noise.
            expect_invisible_on_average(scene, settings(Estimator::mis, 3), 256);
        }
    }
}

// Radiance is eta^2 times as high within the glass, and a path that hits the ball is caught there for long.
TEST_F(SkyFurnaceTest, AWhiteBallInClearGlassIsInvisible) {
    for (const Fresnel fresnel : {Fresnel::schlick, Fresnel::exact}) {
        Scene scene = sphere_of(DielectricMaterial{.ior = 1.7f, .exterior_ior = 1.1f, .fresnel = fresnel});
        add_shape(scene, Sphere{dvec3(0.1, 0.2, 0), 0.5}, add_diffuse(scene, vec3(1)));
        for (const Estimator estimator : ESTIMATORS) {
            SCOPED_TRACE(testing::Message() << int(fresnel) << ' ' << int(estimator));
            expect_invisible_on_average(scene, settings(estimator, 4), samples(512));
        }
    }
}

TEST_F(SkyFurnaceTest, AWhiteBallIsInvisible) {
    const Scene scene = sphere_of(DiffuseMaterial{vec3(1)});
    expect_invisible(scene, without_roulette(Estimator::bsdf, 5));
    expect_invisible_on_average(scene, settings(Estimator::light, 6), samples(1024));
    expect_invisible_on_average(scene, settings(Estimator::mis, 7), samples(512));
}

// Between the rays that return at once and those that are caught: two mirrors and a white floor.
TEST_F(SkyFurnaceTest, BodiesThatLightEachOtherAreInvisible) {
    Scene scene = sphere_of(MirrorMaterial{vec3(1)});
    add_shape(scene, Sphere{dvec3(0.9, -0.6, 1), 0.5}, add_material(scene, DielectricMaterial{}));
    add_shape(scene, Disk{dvec3(0, -1.2, 0), dvec3(0, 0, 2), dvec3(2, 0, 0)}, add_diffuse(scene, vec3(1)));
    for (const Estimator estimator : ESTIMATORS)
        expect_invisible_on_average(scene, settings(estimator, 8), samples(1024));
}

// Integral of f(x, y) over the unit square by the midpoint rule. Twice as many points change the albedos
// below by less than QUADRATURE_ERROR.
double integral(const std::function<double(double, double)>& f) {
    constexpr int POINTS = 1000;
    double sum = 0.0;
    for (int i = 0; i < POINTS; ++i) {
        for (int j = 0; j < POINTS; ++j)
            sum += f((i + 0.5) / POINTS, (j + 0.5) / POINTS);
    }
    return sum / (double(POINTS) * POINTS);
}
constexpr double QUADRATURE_ERROR = 2e-5;

// Share of the light from the direction at theta that the Phong lobe of albedo 1 reflects, (n + 2) / (2 pi)
// times the integral of cos(alpha)^n cos(theta_i): in polar coordinates around the mirrored direction, with
// x = cos(alpha)^(n + 1), so that all points weigh alike.
double phong_lobe_albedo(double n, double theta) {
    return (n + 2.0) / (n + 1.0) * integral([&](double x, double y) {
               const double cos_alpha = std::pow(x, 1.0 / (n + 1.0));
               const double sin_alpha = std::sqrt(1.0 - cos_alpha * cos_alpha);
               return std::max(
                   0.0, cos_alpha * std::cos(theta) + sin_alpha * std::sin(theta) * std::cos(2.0 * M_PI * y));
           });
}

// Share that metal of the roughness alpha reflects of the light from the direction at theta: the integral
// over facets of D cos(theta_h) F G2 (wo.h) / (cos(theta_o) cos(theta_h)), with tan^2(theta_h) = alpha^2 (1 /
// x^3 - 1), so that steep facets, where the shadow's edge is, have many points, of the weight 3 x^2.
// Ref: Walter et al. 2007, equations 13, 20 and 35; Heitz 2014, equation 99.
double metal_albedo(double reflectance, double alpha, double theta) {
    const auto lambda = [&](double cosine) {
        const double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
        return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
    };
    return integral([&](double x, double y) {
        const double cos_h = 1.0 / std::sqrt(1.0 + alpha * alpha * (1.0 / (x * x * x) - 1.0));
        const double o_dot_h = cos_h * std::cos(theta) +
                               std::sqrt(1.0 - cos_h * cos_h) * std::sin(theta) * std::cos(2.0 * M_PI * y);
        const double cos_i = 2.0 * o_dot_h * cos_h - std::cos(theta);
        if (o_dot_h <= 0.0 || cos_i <= 0.0) return 0.0;
        const double fresnel = reflectance + (1.0 - reflectance) * std::pow(1.0 - o_dot_h, 5.0);
        const double shadowing = 1.0 / (1.0 + lambda(std::cos(theta)) + lambda(cos_i));
        return 3.0 * x * x * fresnel * shadowing * o_dot_h / (std::cos(theta) * cos_h);
    });
}

class AlbedoTest : public RenderTest {
  protected:
    static constexpr double ANGLES[] = {0.0, 60.0,
                                        85.0};  // Between the view and the plane's normal [degrees].

    // A plane under a sky of radiance 1, seen at that angle from the normal [rad], so closely that all
    // pixels see it at that angle.
    template <class Model>
    static Scene plane_of(const Model& model, double theta) {
        constexpr float FIELD_OF_VIEW = 1e-3f;
        const dvec3 position(std::sin(theta), std::cos(theta), 0);
        Scene scene = scene_with_camera(5.0 * position, dvec3(0), FIELD_OF_VIEW);
        scene.environment = constant_environment(vec3(1));
        add_shape(scene, Disk{dvec3(0), dvec3(0, 0, 9), dvec3(9, 0, 0)}, add_material(scene, model));
        return scene;
    }
    // The angle differs by half the field of view at the picture's edge, by a third of that in the mean
    // square; the mean of the albedo thereby by less than 1e-6. The densities are evaluated in floats, at a
    // relative error of 2^-17 for the narrowest lobes.
    void expect_albedo(const Scene& scene, Estimator estimator, uint32_t spp, glm::dvec3 albedo) const {
        const RenderSettings settings = independent_settings(32, estimator, 11);
        expect_mean(image_of(render(scene, settings, samples(spp))), albedo, QUADRATURE_ERROR);
    }
};

TEST_F(AlbedoTest, OfPhong) {
    const vec3 diffuse(0.2f, 0.1f, 0), specular(0.3f, 0.6f, 1);
    for (const double n : {0.0, 10.0, 1e3, 1e5}) {
        for (const double angle : ANGLES) {
            SCOPED_TRACE(testing::Message() << "exponent " << n << " at " << angle << " degrees");
            const double lobe = phong_lobe_albedo(n, angle * DEGREE);
            const glm::dvec3 albedo = glm::dvec3(diffuse) + lobe * glm::dvec3(specular);
            const Scene scene = plane_of(PhongMaterial{diffuse, specular, float(n)}, angle * DEGREE);
            expect_albedo(scene, Estimator::bsdf, 1280, albedo);
            if (angle != 60.0) continue;
            expect_albedo(scene, Estimator::mis, 1024, albedo);
            if (n <= 10.0) expect_albedo(scene, Estimator::light, 4096, albedo);
        }
    }
}

TEST_F(AlbedoTest, OfMetal) {
    const vec3 reflectance(0.9f, 0.5f, 0.1f);
    for (const double alpha : {0.05, 0.5, 1.0}) {
        for (const double angle : ANGLES) {
            SCOPED_TRACE(testing::Message() << "alpha " << alpha << " at " << angle << " degrees");
            glm::dvec3 albedo;
            for (int c = 0; c < 3; ++c)
                albedo[c] = metal_albedo(double(reflectance[c]), double(float(alpha)), angle * DEGREE);
            const Scene scene = plane_of(ConductorMaterial{reflectance, float(alpha)}, angle * DEGREE);
            expect_albedo(scene, Estimator::bsdf, 1280, albedo);
            if (angle != 60.0) continue;
            expect_albedo(scene, Estimator::mis, 1024, albedo);
            if (alpha >= 0.5) expect_albedo(scene, Estimator::light, 4096, albedo);
        }
    }
}

}  // namespace
}  // namespace candela
