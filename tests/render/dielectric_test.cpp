// Glass has closed forms: slabs, absorption, total reflection, and the radiance within.
#include <cmath>

#include "render_fixture.h"
#include "support/ggx_reference.h"

namespace candela {
namespace {

constexpr float ETA = 1.5f;
constexpr float THICKNESS = 0.5f;  // Thickness of the slabs [m].

double fresnel(double ior, double theta) {
    return fresnel_exact(std::cos(theta), ior);
}

// Schlick's approximation of that.
double schlick(double ior, double theta) {
    const double normal = fresnel_normal(ior);
    return normal + (1.0 - normal) * std::pow(1.0 - std::cos(theta), 5.0);
}

// A large black panel at that height, that shines downwards or upwards if it has a radiance.
void add_panel(Scene& scene, float height, bool down, std::optional<vec3> radiance) {
    constexpr float REACH = 60.0f;
    const vec3 e1(2 * REACH, 0, 0), e2(0, 0, 2 * REACH);
    std::optional<Emission> emission;
    if (radiance) emission = Emission{*radiance, false};
    add_shape(scene, parallelogram(vec3(-REACH, height, -REACH), down ? e1 : e2, down ? e2 : e1),
              add_diffuse(scene, vec3(0)), emission);
}

class DielectricTest : public RenderTest {
  protected:
    // A scene whose camera looks at the origin from `distance` metres, at theta from +Y [rad]; all rays are
    // as good as parallel: angles differ by half a field of view, and a reflectance by less than 1e-6 on
    // average.
    static Scene scene_seen_at(double theta, double distance) {
        constexpr float FIELD_OF_VIEW = 1e-3f;
        const dvec3 position(distance * std::sin(theta), distance * std::cos(theta), 0);
        Scene scene = scene_with_camera(position, dvec3(0), FIELD_OF_VIEW);
        return scene;
    }
    // Light of RADIANCE must reach the camera with that share. Roundings: some ten vertices of some ten each.
    void expect_fraction(const Scene& scene, uint32_t spp, glm::dvec3 fraction) const {
        const RenderSettings settings = independent_settings(32, Estimator::mis, 1);
        expect_mean(image_of(render(scene, settings, samples(spp))), glm::dvec3(RADIANCE) * fraction, 1e-5);
    }
};

// Light goes to and fro within: T = (1 - R)^2 (1 + R^2 + R^4 + ...) = (1 - R) / (1 + R). The rest is
// reflected.
TEST_F(DielectricTest, ASlabTransmitsAndReflects) {
    for (const Fresnel kind : {Fresnel::schlick, Fresnel::exact}) {
        for (const double degrees : {0.0, 45.0, 75.0}) {
            SCOPED_TRACE(testing::Message() << int(kind) << " at " << degrees << " degrees");
            const double theta = degrees * DEGREE;
            const double r =
                kind == Fresnel::exact ? fresnel(double(ETA), theta) : schlick(double(ETA), theta);
            const double transmitted = (1.0 - r) / (1.0 + r);
            Scene scene = scene_seen_at(theta, 2.0);
            add_slab(scene, {.ior = ETA, .fresnel = kind}, THICKNESS);
            Scene behind = scene;
            add_panel(behind, -2, false, RADIANCE);
            expect_fraction(behind, 1024, glm::dvec3(transmitted));
            Scene in_front = scene;
            add_panel(in_front, 4, true, RADIANCE);
            expect_fraction(in_front, 3200, glm::dvec3(1.0 - transmitted));
        }
    }
}

// A slab that is thinner than what surrounds it: the same, seen from the other side.
TEST_F(DielectricTest, OnlyTheRatioOfTheIndicesCounts) {
    Scene scene = scene_seen_at(0.0, 2.0);
    add_slab(scene, {.ior = 1.2f, .exterior_ior = 1.8f, .fresnel = Fresnel::exact}, THICKNESS);
    add_panel(scene, -2, false, RADIANCE);
    const double r = fresnel(1.8 / 1.2, 0.0);
    expect_fraction(scene, 1024, glm::dvec3((1.0 - r) / (1.0 + r)));
}

// Each pass leaves the share a = exp(-sigma d): T = (1 - R)^2 a (1 + R^2 a^2 + ...).
TEST_F(DielectricTest, ASlabAbsorbs) {
    for (const double degrees : {0.0, 60.0}) {
        SCOPED_TRACE(degrees);
        const double theta = degrees * DEGREE;
        const double r = fresnel(double(ETA), theta);
        const double length =
            double(THICKNESS) / std::sqrt(1.0 - std::pow(std::sin(theta) / double(ETA), 2.0));
        const glm::dvec3 a = glm::exp(-glm::dvec3(ABSORPTION) * length);
        Scene scene = scene_seen_at(theta, 2.0);
        add_slab(scene, {.ior = ETA, .fresnel = Fresnel::exact, .inside = {ABSORPTION}}, THICKNESS);
        add_panel(scene, -2, false, RADIANCE);
        expect_fraction(scene, 4096, (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a));
    }
}

// A panel that shines within the glass: on its way out its radiance is divided by eta^2.
TEST_F(DielectricTest, AnEmitterWithinTheGlass) {
    Scene scene = scene_seen_at(0.0, 2.0);
    add_slab(scene, {.ior = ETA, .inside = {ABSORPTION}}, THICKNESS);
    constexpr float DEPTH = 0.2f;
    add_panel(scene, -DEPTH, false, RADIANCE);
    const double r = fresnel(double(ETA), 0.0);
    const glm::dvec3 a = glm::exp(-glm::dvec3(ABSORPTION) * double(DEPTH));
    expect_fraction(scene, 1024, (1.0 - r) * a / double(ETA * ETA));
}

// A white floor and a lamp in the glass: what reaches the floor is absorbed on its way from the lamp, and
// again on its way to the camera. The lamp fills a cone around 45 degrees; within, at an angle t from its
// axis, the way is D cos(t) - sqrt(r^2 - D^2 sin^2(t)), and cos(t) cos(45) is the mean cosine at the floor.
TEST_F(DielectricTest, ALampWithinTheGlass) {
    constexpr float DEPTH = 1.0f;
    constexpr double LAMP_RADIUS = 0.25;
    const dvec3 center(-0.5, 0.5 - double(DEPTH), 0);
    const double distance = std::sqrt(0.5);
    Scene scene = scene_seen_at(0.0, 2.0);
    add_slab(scene, {.ior = ETA, .inside = {ABSORPTION}}, 2.0f * DEPTH);
    add_panel(scene, -DEPTH, false, {});
    scene.materials.back().model = DiffuseMaterial{vec3(1)};
    add_shape(scene, Sphere{center, LAMP_RADIUS}, add_diffuse(scene, vec3(0)), Emission{RADIANCE, false});

    constexpr int POINTS = 10000;  // Midpoint rule: x = sin^2(t), 2 sin(t) cos(t) dt = dx.
    const double sin2_max = std::pow(LAMP_RADIUS / distance, 2.0);
    glm::dvec3 irradiance_over_pi(0.0);
    for (int i = 0; i < POINTS; ++i) {
        const double x = (i + 0.5) / POINTS * sin2_max;
        const double way = distance * (std::sqrt(1.0 - x) - std::sqrt(sin2_max - x));
        irradiance_over_pi += glm::exp(-glm::dvec3(ABSORPTION) * way) * (std::sqrt(0.5) * sin2_max / POINTS);
    }
    const double r = fresnel(double(ETA), 0.0);
    const glm::dvec3 out = (1.0 - r) / double(ETA * ETA) * glm::exp(-glm::dvec3(ABSORPTION) * double(DEPTH));
    for (const Estimator estimator : {Estimator::bsdf, Estimator::light, Estimator::mis}) {
        SCOPED_TRACE(int(estimator));
        RenderSettings settings = independent_settings(32, estimator, 2);
        settings.max_depth = 2;  // Into the glass, and once off the floor: no light that the glass reflected.
        const Image image =
            image_of(render(scene, settings, samples(estimator == Estimator::bsdf ? 4096 : 1024)));
        expect_mean(image, glm::dvec3(RADIANCE) * out * irradiance_over_pi, 2e-5);
    }
}

// A camera within the glass sees the sky eta^2 times as bright, but for what the boundary reflects, and
// beyond the critical angle (41.8 degrees) only what is inside: a panel at its back.
TEST_F(DielectricTest, ACameraWithinTheGlass) {
    for (const double degrees : {0.0, 30.0, 38.0, 43.0, 70.0}) {
        SCOPED_TRACE(degrees);
        const double theta = degrees * DEGREE;
        const double outside = std::asin(std::min(1.0, double(ETA) * std::sin(theta)));
        const double r = outside < 0.5 * M_PI ? fresnel(double(ETA), outside) : 1.0;
        Scene scene = scene_seen_at(M_PI - theta, 2.0);
        scene.environment = constant_environment(RADIANCE);
        add_slab(scene, {.ior = ETA, .fresnel = Fresnel::exact}, 20.0f);
        add_panel(scene, -10, false, 0.5f * RADIANCE);
        expect_fraction(scene, 1024, glm::dvec3((1.0 - r) * double(ETA * ETA) + 0.5 * r));
    }
}

// Where no ray gets out, nothing is left to chance.
TEST_F(DielectricTest, TotalReflectionIsExact) {
    for (const Fresnel kind : {Fresnel::schlick, Fresnel::exact}) {
        Scene scene = scene_seen_at(120.0 * DEGREE, 2.0);
        scene.environment = constant_environment(vec3(7));
        add_slab(scene, {.ior = ETA, .fresnel = kind}, 20.0f);
        add_panel(scene, -10, false, RADIANCE);
        expect_pixels(image_of(render(scene, independent_settings(16, Estimator::mis, 3), 16)), RADIANCE);
    }
}

}  // namespace
}  // namespace candela
