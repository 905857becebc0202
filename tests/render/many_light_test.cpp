// Lights chosen by the tree where choosing is hard: their sums have closed forms.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

class ManyLightTest : public RenderTest {
  protected:
    // What a Lambert floor reflects of an irradiance, within what varies over the 7 mm of it that are seen.
    void expect_irradiance(const Scene& scene, Estimator estimator, uint32_t spp, dvec3 irradiance) const {
        RenderSettings settings = independent_settings(16, estimator, 0);
        settings.max_depth = 1;
        settings.light_sampler = LightSampler::tree;
        expect_mean(image_of(render(scene, settings, samples(spp))), dvec3(REFLECTANCE) / M_PI * irradiance,
                    2e-4);
    }
};

void add_sphere(Scene& scene, dvec3 center, double radius, vec3 radiance) {
    add_shape(scene, Sphere{.center = center, .radius = radius}, 1,
              Emission{.radiance = radiance, .two_sided = false});
}

// Light samples alone, so that MIS hides no error of a choice.
TEST_F(ManyLightTest, ASkyASunAndAPointAddUp) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(1), vec3(0)}};
    scene.lights.push_back({"", PointLight{.position = {0, 2, 0}, .intensity = vec3(8)}});
    scene.lights.push_back({"", DirectionalLight{.direction = {0, -1, -1}, .irradiance = vec3(1)}});
    expect_irradiance(scene, Estimator::light, 4096, dvec3(0.5 * M_PI + 8.0 / 4.0 + std::sqrt(0.5)));
}

// Nothing tells them apart, so every choice has the same estimate.
TEST_F(ManyLightTest, AMillionCoincidentLightsAreOne) {
    constexpr size_t COUNT = 1'000'000;
    Scene scene = floor_seen_closely(REFLECTANCE);
    scene.lights.assign(COUNT, {"", PointLight{.position = {0, 2, 0}, .intensity = vec3(4.0f / COUNT)}});
    expect_irradiance(scene, Estimator::mis, 256, dvec3(1));
}

// The first covers a quarter of the floor's projected hemisphere. The second is so far away that it does not
// matter where a float places the floor. Those without light, or without an area, change nothing.
TEST_F(ManyLightTest, LightsOfAMicrometreAndOfAThousandKilometresAddUp) {
    Scene scene = floor_seen_closely(REFLECTANCE);
    add_sphere(scene, {0, 2e6, 0}, 1e6, vec3(1, 0, 2));
    add_sphere(scene, {1000, 1000, 0}, 1e-6, vec3(0, 4e18f, 4e18f));
    add_sphere(scene, {-1, 1, 0}, 0.1, vec3(0));
    TriangleMesh needle;
    needle.positions = {{-1, 1, 1}, {-1, 2, 1}, {-1, 3, 1}};
    needle.triangles = {{0, 1, 2}};
    add_shape(scene, needle, 1, Emission{.radiance = vec3(1e12f), .two_sided = true});
    const double small = 4.0 / 2.0 * M_PI * std::sqrt(0.5), large = M_PI / 4.0;
    for (const Estimator estimator : {Estimator::light, Estimator::mis})
        expect_irradiance(scene, estimator, 8192, {large, small, 2.0 * large + small});
}

}  // namespace
}  // namespace candela
