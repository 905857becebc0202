// Russian roulette leaves the mean of every image alone, whatever the probabilities with which it ends paths:
// these show in the number of rays, which has closed forms.
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
    static constexpr uint32_t SPP = 256;

    static RenderSettings settings(uint32_t rr_depth) {
        RenderSettings s = independent_settings(SIZE, Estimator::bsdf, 9);
        s.rr_depth = rr_depth;
        return s;
    }
    // A path must have that many rays: a z-test over all paths, whose variance is known as well.
    void expect_rays(const Scene& scene, const RenderSettings& settings, CountMoments rays) const {
        constexpr double PATHS = double(SIZE) * SIZE * SPP;
        Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings);
        renderer.render(SPP, [](double) { return true; });
        const double mean = double(renderer.counters().rays) / PATHS;
        const double error = std::sqrt((rays.square - rays.mean * rays.mean) / PATHS);
        EXPECT_GT(normal_p_value((mean - rays.mean) / error), TEST_ALPHA)
            << mean << " rays a path, not " << rays.mean << "; z = " << (mean - rays.mean) / error;
    }
};

// In a closed box a path goes on with the share of the light that it carries: the first d vertices leave that
// at a^d, the roulette of the next one takes a^(d + 1) for the probability and restores the weight to 1, and
// all others have the probability a. After the d + 1 certain rays, there are k > 0 more with the probability
// a^(d + 1) a^(k - 1) (1 - a).
TEST_F(RouletteTest, APathGoesOnWithWhatItCarries) {
    for (const float albedo : {0.3f, 0.8f}) {
        for (const uint32_t rr_depth : {0u, 3u}) {
            SCOPED_TRACE(testing::Message() << "albedo " << albedo << " from bounce " << rr_depth);
            const auto a = double(albedo);
            const double certain = rr_depth + 1.0;
            const double share = std::pow(a, certain);
            const CountMoments more{share / (1.0 - a), share * (1.0 + a) / ((1.0 - a) * (1.0 - a))};
            expect_rays(furnace(albedo), settings(rr_depth),
                        {certain + more.mean, certain * certain + 2.0 * certain * more.mean + more.square});
        }
    }
}

// Within glass a path from outside weighs 1 / eta^2 only, though nothing is lost: that must not end it. It
// always survives with the most that is allowed, s. With the reflectance R and T = 1 - R, a ray that enters
// the slab is the first of M = 1 + (1 with probability s T, as many again with s R, else 0), and the camera's
// is the first of 1 + (1 with s R, M with s T, else 0).
TEST_F(RouletteTest, ClearGlassEndsNoMorePathsThanItMust) {
    constexpr double S = 0.95;  // RR_MAX_SURVIVAL of path.glsl.
    constexpr float IOR = 1.8f;
    Scene scene = scene_with_camera(vec3(0, 2, 0), vec3(0), 1e-3f);
    scene.environment = constant_environment(vec3(1));
    const uint32_t glass = add_material(scene, DielectricMaterial{.ior = IOR, .fresnel = Fresnel::exact});
    add_shape(scene, Disk{vec3(0), vec3(0, 0, 9), vec3(9, 0, 0)}, glass);
    add_shape(scene, Disk{vec3(0, -1, 0), vec3(9, 0, 0), vec3(0, 0, 9)}, glass);
    const double r = std::pow((double(IOR) - 1.0) / (double(IOR) + 1.0), 2.0);
    const double sr = S * r, st = S * (1.0 - r);
    const double m = (1.0 + st) / (1.0 - sr);
    const double m2 = (2.0 * m - 1.0 + st) / (1.0 - sr);
    expect_rays(scene, settings(0), {1.0 + sr + st * m, 1.0 + 2.0 * (sr + st * m) + sr + st * m2});
}

}  // namespace
}  // namespace candela
