// Russian roulette does not change the mean of any image, regardless of the probabilities with which it ends
// paths: these show in the number of rays, which has closed forms.
#include <cmath>

#include "render_fixture.h"

namespace candela {
namespace {

// Mean and mean square of a whole number that chance decides.
struct CountMoments {
    double mean, square;
};

class RouletteTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 32;
    static uint32_t spp() { return samples(256); }

    static RenderSettings settings(uint32_t rr_depth) {
        RenderSettings s = independent_settings(SIZE, Estimator::bsdf, 9);
        s.rr_depth = rr_depth;
        return s;
    }
    // A path must have that many rays: a z-test over all paths, whose variance is known as well.
    void expect_rays(const Scene& scene, const RenderSettings& settings, CountMoments rays) const {
        const double paths = double(SIZE) * SIZE * spp();
        Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings);
        renderer.render(spp(), [](double) { return true; });
        const double mean = double(renderer.counters().rays) / paths;
        const double error = std::sqrt((rays.square - rays.mean * rays.mean) / paths);
        EXPECT_GT(normal_p_value((mean - rays.mean) / error), TEST_ALPHA)
            << mean << " rays a path, not " << rays.mean << "; z = " << (mean - rays.mean) / error;
    }
};

// In a closed box all paths have the same throughput: a^d after d vertices without roulette. With it, each
// vertex multiplies the throughput by a; the root of that is the probability to go on and, by division, the
// new throughput. So the probability of n rays is a product, which the test follows until it vanishes.
TEST_F(RouletteTest, APathGoesOnWithWhatItCarries) {
    for (const float albedo : {0.3f, 0.8f}) {
        for (const uint32_t rr_depth : {0u, 3u}) {
            SCOPED_TRACE(testing::Message() << "albedo " << albedo << " from bounce " << rr_depth);
            const double certain = rr_depth + 1.0;
            CountMoments rays{certain, certain * certain};
            double fraction = std::pow(double(albedo), rr_depth);
            double reached = 1.0;  // The probability of n rays.
            for (double n = certain + 1.0; reached > 1e-12; ++n) {
                fraction = std::sqrt(double(albedo) * fraction);
                reached *= fraction;
                rays.mean += reached;
                rays.square += reached * (2.0 * n - 1.0);
            }
            expect_rays(furnace(albedo), settings(rr_depth), rays);
        }
    }
}

constexpr double S = 0.99;  // RR_MAX_SURVIVAL of path.glsl.

// The moments if one ray is certain, and a second and a third have these probabilities.
CountMoments up_to_three(double second, double third) {
    return {1.0 + second + third, 1.0 + 3.0 * second + 5.0 * third};
}

// Within glass a path from outside has a throughput of 1 / eta^2, though nothing is lost: that must not end
// it where it hits something white.
TEST_F(RouletteTest, WithinClearGlassNoMorePathsEndThanMust) {
    constexpr float IOR = 1.8f;
    Scene scene = scene_with_camera(dvec3(0, 2, 0), dvec3(0), 1e-3f);
    scene.environment = constant_environment(vec3(1));
    const uint32_t glass = add_material(scene, DielectricMaterial{.ior = IOR, .fresnel = Fresnel::exact});
    const uint32_t white = add_material(scene, DiffuseMaterial{vec3(1)});
    add_shape(scene, Disk{dvec3(0), dvec3(0, 0, 9), dvec3(9, 0, 0)}, glass);
    add_shape(scene, Disk{dvec3(0, -1, 0), dvec3(0, 0, 9), dvec3(9, 0, 0)}, white);
    RenderSettings two = settings(0);
    two.max_depth = 2;
    const double r = std::pow((double(IOR) - 1.0) / (double(IOR) + 1.0), 2.0);
    expect_rays(scene, two, up_to_three(S, S * (1.0 - r) * S));
}

// Only the path itself can find what a mirror shows: it goes on, however dark the mirror is. After the next
// hit, on a wall, its throughput is used.
TEST_F(RouletteTest, AMirrorEndsNoMorePathsThanItMust) {
    constexpr float GREY = 0.25f;
    Scene scene = scene_with_camera(dvec3(0, 2, 0), dvec3(0), 1e-3f);
    scene.environment = constant_environment(vec3(1));
    const uint32_t mirror = add_material(scene, MirrorMaterial{vec3(GREY)});
    const uint32_t white = add_material(scene, DiffuseMaterial{vec3(1)});
    add_shape(scene, Disk{dvec3(0), dvec3(0, 0, 9), dvec3(9, 0, 0)}, mirror);
    add_shape(scene, Disk{dvec3(0, 3, 0), dvec3(9, 0, 0), dvec3(0, 0, 9)}, white);
    RenderSettings two = settings(0);
    two.max_depth = 2;
    expect_rays(scene, two, up_to_three(S, S * std::sqrt(double(GREY) / S)));
}

// A floor that reflects half of its light as a mirror would and half diffusely, under a sky that is bright
// only where the mirror shows it: if the number that chose the lobe decided survival as well, only one lobe
// would survive.
TEST_F(RouletteTest, WhichLobeWasChosenDoesNotDecideWhoSurvives) {
    Scene scene = scene_with_camera(dvec3(0, 2, 0), dvec3(0), 1e-3f);
    scene.environment = Environment{.size = {1, 8}, .radiance = std::vector<vec3>(8, vec3(0.1f))};
    scene.environment->radiance[0] = vec3(4);
    const uint32_t phong = add_material(scene, PhongMaterial{vec3(0.4f), vec3(0.4f), 1e5f});
    add_shape(scene, Disk{dvec3(0), dvec3(0, 0, 9), dvec3(9, 0, 0)}, phong);
    RenderSettings once = settings(0);
    once.max_depth = 1;
    RenderSettings never = once;
    never.rr_depth = DEPTH_SAFETY_LIMIT;
    ++never.seed;
    expect_same_expectation(image_of(render(scene, once, spp())), image_of(render(scene, never, spp())));
}

}  // namespace
}  // namespace candela
