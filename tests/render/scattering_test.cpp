// Media that scatter light: what loses nothing is invisible, and some of the rest has closed forms.
#include <array>
#include <cmath>
#include <numbers>

#include "estimator_fixture.h"

namespace candela {
namespace {

Medium scattering(vec3 coefficient, float g = 0.0f, vec3 absorption = vec3(0)) {
    return {absorption, coefficient, g};
}

// A box that reaches so far to the sides that no path of a test comes there, from y = -depth to 0.
void add_deep_slab(Scene& scene, const InterfaceMaterial& material, float reach, float depth) {
    const uint32_t m = add_material(scene, material);
    const vec3 lo(-reach, -depth, -reach), hi(reach, 0, reach), e = hi - lo;
    const vec3 x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
    for (const Quad& side : {parallelogram(lo, x, z), parallelogram(lo, y, x), parallelogram(lo, z, y),
                             parallelogram(hi, -z, -x), parallelogram(hi, -x, -y), parallelogram(hi, -y, -z)})
        add_shape(scene, side, m);
}

class ScatteringTest : public EstimatorTest {
  protected:
    // A unit sphere that fills most of the picture, seen against a sky of radiance 1.
    template <class Model>
    static Scene ball_of(const Model& model, dvec3 camera = dvec3(1, 2, 4.5)) {
        Scene scene = scene_with_camera(camera, dvec3(0), 0.4f);
        scene.environment = constant_environment(vec3(1));
        add_shape(scene, Sphere{}, add_material(scene, model));
        return scene;
    }
    // A point seen from far above, at that cosine to the vertical, so narrowly that all rays are as good as
    // one.
    static Scene seen_from(double cosine) {
        const double sine = std::sqrt(1.0 - cosine * cosine);
        Scene scene = scene_with_camera(10.0 * dvec3(sine, cosine, 0), dvec3(0), 1e-4f);
        scene.cameras[0].up = dvec3(0, 0, 1);
        return scene;
    }
    static RenderSettings settings(Estimator estimator, uint32_t seed) {
        return independent_settings(32, estimator, seed);
    }
    void expect_mean_of(const Scene& scene, glm::dvec3 expected, uint32_t spp, double systematic,
                        RenderSettings s = settings(Estimator::mis, 1)) const {
        expect_mean(image_of(render(scene, s, samples(spp))), expected, systematic);
    }
    // Paths of up to some hundred vertices, each of which rounds the throughput some ten times, up or down.
    // All estimators do the same under such a sky.
    void expect_invisible(const Scene& scene, uint32_t spp) const {
        expect_mean_of(scene, glm::dvec3(1.0), spp, 0x1p-16);
    }
};

TEST_F(ScatteringTest, ACloudThatLosesNothingIsInvisible) {
    for (const float g : {0.0f, 0.9f, -0.999f}) {
        SCOPED_TRACE(g);
        expect_invisible(ball_of(InterfaceMaterial{scattering(vec3(0.1f, 1, 5), g)}), 512);
    }
}

TEST_F(ScatteringTest, MilkyGlassThatLosesNothingIsInvisible) {
    expect_invisible(
        ball_of(DielectricMaterial{.fresnel = Fresnel::exact, .inside = scattering(vec3(3), 0.7f)}), 64);
    expect_invisible(ball_of(DielectricMaterial{.ior = 1.0f, .inside = scattering(vec3(3), -0.7f)}), 64);
}

TEST_F(ScatteringTest, WaxThatLosesNothingIsInvisible) {
    expect_invisible(
        ball_of(DiffuseTransmissionMaterial{vec3(0.2f), vec3(0.8f), scattering(vec3(8, 4, 2), 0.5f)}), 256);
    PrincipledMaterial wax{.base_color = vec3(1), .roughness = 0.3f, .inside = scattering(vec3(4), 0.5f)};
    wax.diffuse_transmission = 0.8f;
    expect_invisible(ball_of(wax), 256);
}

// The last of these stands half outside of the others, and has a higher priority.
TEST_F(ScatteringTest, MediaWithinMediaThatLoseNothingAreInvisible) {
    Scene scene = ball_of(InterfaceMaterial{scattering(vec3(2, 1, 0.5f), 0.5f)});
    add_shape(scene, Sphere{dvec3(0.3, 0, 0), 0.5},
              add_material(scene, InterfaceMaterial{scattering(vec3(4), -0.9f)}));
    add_shape(scene, Sphere{dvec3(0.4, 0, 0), 0.2},
              add_material(scene, DielectricMaterial{.ior = 1.3f, .fresnel = Fresnel::exact, .inside = {}}));
    add_shape(scene, Sphere{dvec3(-0.8, 0.2, 0), 0.6},
              add_material(
                  scene, DielectricMaterial{
                             .fresnel = Fresnel::exact, .inside = scattering(vec3(1, 2, 3)), .priority = 1}));
    expect_invisible(scene, 256);
}

TEST_F(ScatteringTest, ACloudAroundTheCameraThatLosesNothingIsInvisible) {
    expect_invisible(ball_of(InterfaceMaterial{scattering(vec3(0.5f, 1, 3), 0.6f)}, dvec3(0.2, -0.1, 0.7)),
                     512);
}

// Straight through two spheres, one within the other; also where floats hold next to nothing of it, or
// nothing.
TEST_F(ScatteringTest, InterfacesDimWhatIsBehind) {
    for (const float depth : {1e-3f, 1.0f, 20.0f, 80.0f, 200.0f}) {
        const vec3 inner(0.5f * depth, 0.1f * depth, 0), outer(0, 0.2f * depth, 0.5f * depth);
        Scene scene = seen_from(1.0);
        scene.environment = constant_environment(vec3(1));
        add_shape(scene, Sphere{}, add_material(scene, InterfaceMaterial{{outer}}));
        add_shape(scene, Sphere{dvec3(0), 0.5}, add_material(scene, InterfaceMaterial{{inner}}));
        const Image image = image_of(render(scene, settings(Estimator::mis, 3), 4));
        for (size_t c = 0; c < 3; ++c) {
            const double passed = std::exp(-double(inner[int(c)]) - double(outer[int(c)]));
            // Vulkan's exponential is off by (3 + 2 |x|) ulp; below 2^-126, floats may be flushed.
            const double error = passed * (8.0 + 8.0 * double(depth)) * 0x1p-23 + 0x1p-126;
            for (const float value : plane(image, "", c))
                ASSERT_NEAR(value, passed, error) << depth;
        }
    }
}

// A wall that shines, ten metres away.
TEST_F(ScatteringTest, AMediumAroundEverythingDimsWhatIsBehindIt) {
    Scene scene = seen_from(1.0);
    scene.medium = scattering(0.05f * ABSORPTION, 0.0f, 0.05f * ABSORPTION);
    add_shape(scene, parallelogram(vec3(-5, 0, 5), vec3(10, 0, 0), vec3(0, 0, -10)),
              add_diffuse(scene, vec3(0)), Emission{RADIANCE});
    RenderSettings s = settings(Estimator::mis, 6);
    s.max_depth = 0;
    expect_mean_of(scene, glm::dvec3(RADIANCE) * glm::exp(-glm::dvec3(ABSORPTION)), 4096, 1e-5, s);
}

// A floor under a point light, with all kinds of boundaries in between. What is beyond the light casts no
// shadow.
TEST_F(ScatteringTest, ShadowRaysPassInterfaces) {
    Scene scene = scene_with_camera(dvec3(6, 0.2, 0), dvec3(0), 1e-4f);
    add_shape(scene, parallelogram(vec3(-50, 0, 50), vec3(100, 0, 0), vec3(0, 0, -100)),
              add_diffuse(scene, REFLECTANCE));
    const vec3 scattered(0.2f, 0.1f, 0.4f);
    const Medium cloud = scattering(scattered, 0.3f, ABSORPTION);
    add_shape(scene, Sphere{dvec3(0, 2, 0), 0.5}, add_material(scene, InterfaceMaterial{cloud}));
    add_shape(scene, Sphere{dvec3(0, 2, 0), 0.25}, add_material(scene, InterfaceMaterial{{}}));
    add_shape(scene, Sphere{dvec3(0, 3.5, 0), 0.25},
              add_material(scene, DielectricMaterial{.ior = 1.0f, .inside = {2.0f * ABSORPTION}}));
    add_shape(scene, parallelogram(vec3(-2, 5.1f, -2), vec3(4, 0, 0), vec3(0, 0, 4)), 0);
    scene.lights = {{"", PointLight{dvec3(0, 5, 0), vec3(50)}}};
    const glm::dvec3 passed = glm::exp(-0.5 * glm::dvec3(ABSORPTION + scattered) - glm::dvec3(ABSORPTION));
    RenderSettings s = settings(Estimator::light, 4);
    s.max_depth = 1;
    expect_mean_of(scene, glm::dvec3(REFLECTANCE) / M_PI * 2.0 * passed, 4, 1e-5, s);
    // What does not let light pass straight blocks it.
    add_shape(scene, Sphere{dvec3(0, 4.5, 0), 0.1}, add_material(scene, DielectricMaterial{}));
    expect_pixels(image_of(render(scene, s, 4)), vec3(0));
}

// Light from a direction whose cosine to the vertical is `sun`, scattered once in a slab, and seen from
// above: the integral over the depth t along the view of sigma_s p E exp(-sigma_t t (1 + cosine / sun)).
TEST_F(ScatteringTest, SingleScatteringInASlab) {
    const double thickness = 0.7, sun = 0.5;
    for (const float g : {0.0f, 0.6f, -0.4f}) {
        for (const double cosine : {1.0, 0.4}) {
            SCOPED_TRACE(testing::Message() << g << ' ' << cosine);
            Scene scene = seen_from(cosine);
            const Medium medium = scattering(vec3(0.2f, 1, 3), g, ABSORPTION);
            add_deep_slab(scene, {medium}, 1000.0f, float(thickness));
            const double sine = std::sqrt(1.0 - sun * sun);
            scene.lights = {
                {"", DirectionalLight{.direction = dvec3(0, -sun, sine), .irradiance = RADIANCE}}};
            // Between the direction of the view, downwards, and that towards the light.
            const double angle_cosine = -cosine * sun;
            const double gg = double(g) * double(g);
            const double p =
                (1.0 - gg) / (4.0 * M_PI * std::pow(1.0 + gg - 2.0 * double(g) * angle_cosine, 1.5));
            const glm::dvec3 s(medium.scattering), t(medium.scattering + medium.absorption);
            const double both = 1.0 + cosine / sun;
            const glm::dvec3 expected = glm::dvec3(RADIANCE) * p * s / (t * both) *
                                        (1.0 - glm::exp(-t * both * (thickness / cosine)));
            RenderSettings once = settings(Estimator::light, 5);
            once.max_depth = 1;
            expect_mean_of(scene, expected, 1024, 1e-5, once);
        }
    }
}

// Chandrasekhar's H for isotropic scattering, at the midpoints of as many intervals of [0, 1].
// Ref: Chandrasekhar 1960, Radiative Transfer, chapter V: 1 / H(x) = sqrt(1 - a) + a / 2 integral of y H(y) /
// (x + y).
std::vector<double> h_function(double albedo, size_t points) {
    std::vector<double> h(points, 1.0), next(points);
    const auto at = [&](size_t i) { return (double(i) + 0.5) / double(points); };
    for (double change = 1.0; change > 1e-12;) {
        change = 0.0;
        for (size_t i = 0; i < points; ++i) {
            double sum = 0.0;
            for (size_t j = 0; j < points; ++j)
                sum += at(j) * h[j] / (at(i) + at(j));
            next[i] = 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum / double(points));
            change = std::max(change, std::abs(next[i] - h[i]));
        }
        h = next;
    }
    return h;
}

constexpr size_t H_POINTS = 400;  // Twice as many change the results by less than 1e-5.
const vec3 DEEP_ALBEDO(0.5f, 0.8f, 0.95f);

// A medium that fills half of space, under a sky of radiance 1, has the radiance 1 - H(x) sqrt(1 - albedo)
// where it is seen at the cosine x, the midpoint of that interval of [0, 1]. (By reciprocity, that is what it
// reflects of light from there.)
glm::dvec3 deep_radiance(size_t place) {
    glm::dvec3 radiance;
    for (const int c : {0, 1, 2}) {
        const double a = double(DEEP_ALBEDO[c]);
        radiance[c] = 1.0 - h_function(a, H_POINTS)[place] * std::sqrt(1.0 - a);
    }
    return radiance;
}

class DeepMediumTest : public ScatteringTest {
  protected:
    static Scene scene_at(size_t place) {
        Scene scene = seen_from((double(place) + 0.5) / double(H_POINTS));
        scene.environment = constant_environment(vec3(1));
        add_deep_slab(scene, {scattering(50.0f * DEEP_ALBEDO, 0.0f, 50.0f * (vec3(1) - DEEP_ALBEDO))}, 100.0f,
                      10.0f);
        return scene;
    }
};

TEST_F(DeepMediumTest, ReflectsWhatChandrasekharSays) {
    for (const size_t place : {H_POINTS - 1, H_POINTS / 4})
        expect_mean_of(scene_at(place), deep_radiance(place), 1024, 1e-4);
}

TEST_F(DeepMediumTest, ReflectsWhatChandrasekharSaysToTheThousandth) {
    for (const size_t place : {H_POINTS - 1, H_POINTS / 4}) {
        const Image seen = image_of(render(scene_at(place), settings(Estimator::mis, 1), samples(32768)));
        for (const size_t c : {0, 1, 2}) {
            const double expected = deep_radiance(place)[int(c)];
            EXPECT_NEAR(image_mean(seen, c).mean, expected, 1e-3 * expected);
        }
    }
}

// Paths walk in solids that no light sample reaches. A dark light within a solid lets them take light samples
// there, too, which finds nothing.
TEST_F(ScatteringTest, WalksAreWhatOtherPathsAre) {
    PrincipledMaterial skin{.base_color = vec3(0.9f, 0.6f, 0.4f), .roughness = 0.3f};
    skin.diffuse_transmission = 0.6f;
    skin.inside = scattering(vec3(5, 12, 20), 0.3f, vec3(0.2f, 0.5f, 1));
    const Medium milk = scattering(vec3(3, 2, 1), -0.4f, vec3(0.1f, 0.2f, 0.3f));
    Scene walks = scene_with_camera(dvec3(0, 1, 5), dvec3(0), 0.8f);
    add_shape(walks, Sphere{dvec3(-1.1, 0, 0), 1.0}, add_material(walks, skin));
    add_shape(walks, Sphere{dvec3(1.1, 0, 0), 1.0},
              add_material(walks, DielectricMaterial{.fresnel = Fresnel::exact, .inside = milk}));
    add_shape(walks, Sphere{dvec3(1.3, 0.1, 0), 0.5},
              add_material(walks, DielectricMaterial{.ior = 1.2f, .inside = scattering(vec3(6))}));
    walks.lights = {{"", PointLight{dvec3(3, 3, 3), vec3(12)}}};
    walks.environment = constant_environment(vec3(0.4f, 0.5f, 0.6f));
    Scene others = walks;
    others.lights.push_back({"", PointLight{dvec3(-1.1, 0, 0), vec3(0)}});
    ASSERT_TRUE(build_gpu_scene(walks).sealed_media);
    ASSERT_FALSE(build_gpu_scene(others).sealed_media);
    const auto picture = [&](const Scene& scene, Backdrop backdrop, uint32_t seed, uint32_t spp) {
        RenderSettings s = settings(Estimator::mis, seed);
        const bool transmission = backdrop == Backdrop::transmitted;
        s.backdrop = backdrop;
        s.aovs = transmission;
        return make_image(render(scene, s, spp), {.variance = true, .transmission = transmission}, {});
    };
    expect_same_expectation(picture(walks, Backdrop::environment, 13, samples(384)),
                            picture(others, Backdrop::environment, 14, samples(384)));
    // What has been scattered shows no background.
    const auto alpha = [&](const Scene& scene, uint32_t seed) {
        return coverage(picture(scene, Backdrop::transmitted, seed, samples(64)));
    };
    EXPECT_NEAR(alpha(walks, 15), alpha(others, 16),
                5.0 * std::sqrt(2.0 * 0.25 / (32.0 * 32.0 * samples(64))));
}

// A path that walks out of an open vessel finds a lamp that light samples do not look for there.
TEST_F(ScatteringTest, WalksFindLampsThroughOpenings) {
    const Medium milk = scattering(vec3(1.5f, 1, 0.5f), 0.2f, vec3(0.05f, 0.1f, 0.2f));
    TriangleMesh vessel = sphere_mesh(12, 16);
    std::erase_if(vessel.triangles, [&](uvec3 t) { return vessel.positions[t.x].y > 0.6f; });
    Scene walks = scene_with_camera(dvec3(0, 0.5, 6), dvec3(0, -0.1, 0), 0.25f);
    add_shape(walks, vessel, add_material(walks, DiffuseTransmissionMaterial{vec3(0.1f), vec3(0.6f), milk}));
    add_shape(walks, parallelogram(vec3(-1, 1, -1), vec3(2, 0, 0), vec3(0, 0, 2)),
              add_diffuse(walks, vec3(0)), Emission{vec3(4)});
    Scene others = walks;
    others.lights.push_back({"", PointLight{dvec3(0), vec3(0)}});
    ASSERT_TRUE(build_gpu_scene(walks).sealed_media);
    ASSERT_FALSE(build_gpu_scene(others).sealed_media);
    const auto picture = [&](const Scene& scene, uint32_t seed) {
        return make_image(render(scene, settings(Estimator::mis, seed), samples(2560)), {.variance = true},
                          {});
    };
    expect_same_expectation(picture(walks, 17), picture(others, 18));
}

TEST_F(ScatteringTest, EstimatorsAgreeInHaze) {
    Scene scene = hazy_room();
    scene.lights.clear();
    expect_estimators_agree(scene, 1024, 896);
}

TEST_F(ScatteringTest, ChoicesOfLightsAgreeInHaze) {
    const Scene scene = hazy_room();
    const auto with = [&](LightSampler sampler, uint32_t seed) {
        RenderSettings s = EstimatorTest::settings(Estimator::mis, seed);
        s.light_sampler = sampler;
        return image(scene, s, 512);
    };
    const Image tree = with(LightSampler::tree, 6);
    expect_same_expectation(with(LightSampler::power, 7), tree);
    expect_same_expectation(with(LightSampler::uniform, 8), tree);
}

// Haze without an end, from which paths return by chance.
TEST_F(ScatteringTest, RouletteInHazeDoesNotChangeTheMean) {
    Scene scene = scene_with_camera(dvec3(0, 0, 1.2), dvec3(0), 1.0f);
    scene.medium = scattering(vec3(0.5f, 1, 1.5f), 0.0f, vec3(0.3f));
    add_shape(scene, Sphere{dvec3(0), 0.5}, add_diffuse(scene, vec3(0.5f)), Emission{RADIANCE});
    RenderSettings none = settings(Estimator::mis, 9);
    none.rr_depth = DEPTH_SAFETY_LIMIT;
    none.max_depth = 80;  // Less than 2^-20 of the light is left: each vertex takes a sixth or more.
    expect_same_expectation(image_of(render(scene, settings(Estimator::mis, 10), samples(1000))),
                            image_of(render(scene, none, samples(600))));
}

// Alpha is the probability of meeting the medium, whatever it does to the light.
TEST_F(ScatteringTest, ACloudCoversWhatItHides) {
    Scene scene = seen_from(1.0);
    add_deep_slab(scene, {scattering(vec3(0.4f), 0.0f, vec3(0.3f))}, 100.0f, 1.0f);
    const Image image = image_of(render(scene, settings(Estimator::bsdf, 11), samples(256)));
    const double expected = 1.0 - std::exp(-0.7), count = 32.0 * 32.0 * samples(256);
    EXPECT_NEAR(coverage(image), expected, 5.0 * std::sqrt(expected * (1.0 - expected) / count));
}

// Whatever a medium is, a picture of it comes to an end; paths that would go on are counted.
TEST_F(ScatteringTest, ExtremeMediaEnd) {
    const auto cut = [&](const Scene& scene) {
        Renderer renderer(device(), build_gpu_scene(scene), scene.cameras[0], settings(Estimator::mis, 12));
        EXPECT_TRUE(renderer.render(2, [](double) { return true; }));
        EXPECT_EQ(renderer.counters().nonfinite_samples, 0u);
        return renderer.counters().depth_limit_hits;
    };
    const auto glass = [](const Medium& inside) { return DielectricMaterial{.ior = 1.5f, .inside = inside}; };
    cut(ball_of(InterfaceMaterial{scattering(vec3(0.999e6f), 0.0f, vec3(1e3f))}));
    cut(ball_of(glass(scattering(vec3(0.999e6f), 0.999f, vec3(1e3f)))));
    EXPECT_EQ(cut(ball_of(InterfaceMaterial{scattering(vec3(5), -0.999f)})), 0u);
    cut(ball_of(glass(scattering(vec3(5), 0.999f))));
    // Nothing lets the light out again.
    Scene closed = scene_with_camera(dvec3(0), dvec3(1, 0, 0), 1.0f);
    add_shape(closed, Sphere{dvec3(0), 2.0}, add_material(closed, MirrorMaterial{vec3(1)}));
    add_shape(closed, Sphere{}, add_material(closed, InterfaceMaterial{scattering(vec3(20))}));
    EXPECT_GT(cut(closed), 0u);
}

}  // namespace
}  // namespace candela
