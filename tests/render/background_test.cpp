// Before a background: what hides it, and how much of it glass lets through, against closed forms.
#include <cmath>

#include "render_fixture.h"
#include "support/ggx_reference.h"

namespace candela {
namespace {

constexpr float SLAB = 0.5f;

RenderSettings settings_before(Backdrop backdrop) {
    RenderSettings settings = independent_settings(32, Estimator::mis, 3);
    settings.rr_depth = settings.max_depth;  // So that every sample of glass lets through all or nothing.
    settings.backdrop = backdrop;
    settings.aovs = backdrop == Backdrop::transmitted;
    return settings;
}

double mean_of(const Image& image, const char* channel) {
    RunningMoments moments;
    for (const float value : image.find(channel)->values)
        moments.add(value);
    return moments.mean();
}

// A camera that looks straight down at the origin with parallel rays, below a sky of radiance 1.
Scene scene_from_above() {
    Scene scene = scene_with_camera(dvec3(0, 10, 0), dvec3(0), 1.0f);
    scene.cameras[0].up = vec3(0, 0, -1);
    scene.cameras[0].ortho_height = 1.0;
    scene.environment = constant_environment(vec3(1));
    return scene;
}

class BackgroundTest : public RenderTest {
  protected:
    Image image(const Scene& scene, Backdrop backdrop, uint32_t spp) const {
        return make_image(render(scene, settings_before(backdrop), spp),
                          {.variance = true, .transmission = backdrop == Backdrop::transmitted}, {});
    }
    // A must have that mean over the picture, where each sample lets `most` through at most: the variance of
    // such a sample is at most that of one that lets all of it through or nothing.
    void expect_alpha(const Scene& scene, double transmission, double most, uint32_t spp) const {
        const Image seen = image(scene, Backdrop::transmitted, spp);
        const double n = double(seen.pixel_count()) * spp;
        const double error = std::sqrt(transmission * (most - transmission) / n);
        EXPECT_LT(error, largest_error());
        const double z = (1.0 - mean_of(seen, "A") - transmission) / error;
        EXPECT_GT(normal_p_value(z), TEST_ALPHA)
            << "1 - A is " << 1.0 - mean_of(seen, "A") << ", not " << transmission;
        EXPECT_EQ(mean_of(seen, FIRST_HIT_ALPHA), 1.0);
    }
};

// Both faces reflect R = ((n - 1) / (n + 1))^2 of what reaches them straight: (1 - R)^2 passes without having
// been reflected, times what the medium leaves of it. The rest comes from the sky, too.
TEST_F(BackgroundTest, IsSeenThroughASlabOfGlass) {
    const double passes = std::pow(1.0 - fresnel_normal(1.5), 2.0);
    Scene clear = scene_from_above();
    add_slab(clear, {.ior = 1.5f}, SLAB);
    expect_alpha(clear, passes, 1.0, samples(256));
    const Image seen = image(clear, Backdrop::transmitted, samples(256));
    for (size_t i = 0; i < seen.pixel_count(); ++i)  // The samples' sums differ by rounding.
        ASSERT_NEAR(seen.find("A")->values[i], plane(seen, "", 0)[i], 1e-5);

    Scene tinted = scene_from_above();
    add_slab(tinted, {.ior = 1.5f, .inside = {.absorption = ABSORPTION}}, SLAB);
    double left = 0.0;
    const double weights[] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; ++c)
        left += weights[c] * std::exp(-double(ABSORPTION[c]) * double(SLAB));
    expect_alpha(tinted, passes * left, left, samples(256));
}

// Under water, radiance is n^2 times that of the sky; a background is seen as it is.
TEST_F(BackgroundTest, IsNotScaledByRefraction) {
    Scene scene = scene_from_above();
    add_slab(scene, {.ior = 1.5f}, SLAB);
    scene.cameras[0].position = dvec3(0, -0.25, 0);
    scene.cameras[0].look_at = dvec3(0, -1, 0);
    expect_alpha(scene, 1.0 - fresnel_normal(1.5), 1.0, samples(256));
}

// Veils of opacity 0.3 before a mirror that covers the left half: what is beside it shows the background.
TEST_F(BackgroundTest, IsHiddenByMirrorsAndVeiledByOpacity) {
    Scene scene = scene_from_above();
    Material veil{.name = "veil", .model = DiffuseMaterial{.reflectance = vec3(0)}};
    veil.opacity.value = 0.3f;
    scene.materials.push_back(veil);
    add_shape(scene, parallelogram(vec3(-5, 1, 5), vec3(10, 0, 0), vec3(0, 0, -10)), 0);
    add_shape(scene, parallelogram(vec3(-5, 0, 5), vec3(5, 0, 0), vec3(0, 0, -10)),
              add_material(scene, MirrorMaterial{}));
    const uint32_t spp = samples(1024);
    for (const Backdrop backdrop : {Backdrop::background, Backdrop::transmitted}) {
        const Image seen = image(scene, backdrop, spp);
        RunningMoments mirror_light, free_light, free_alpha;
        for (size_t i = 0; i < seen.pixel_count(); ++i) {
            const bool mirror = i % 32 < 16;
            const float alpha = seen.find("A")->values[i], light = plane(seen, "", 1)[i];
            (mirror ? mirror_light : free_light).add(light);
            if (mirror) {
                ASSERT_EQ(alpha, 1.0f);
            } else {
                free_alpha.add(alpha);
            }
        }
        const double error = std::sqrt(0.21 / (512.0 * spp));
        EXPECT_LT(error, largest_error());
        EXPECT_GT(normal_p_value((free_alpha.mean() - 0.3) / error), TEST_ALPHA) << free_alpha.mean();
        EXPECT_EQ(free_light.mean(), 0.0);
        EXPECT_NEAR(mirror_light.mean(), 0.49, 6.0 * error);  // To the mirror and back.
    }
}

// By the other convention, the sky is seen through glass, and the background is not.
TEST_F(BackgroundTest, IsHiddenByGlassIfFirstHitsDecide) {
    Scene scene = scene_from_above();
    add_slab(scene, {.ior = 1.5f}, SLAB);
    const Image seen = image(scene, Backdrop::background, 4);
    EXPECT_EQ(coverage(seen), 1.0);
    for (size_t i = 0; i < seen.pixel_count(); ++i)
        ASSERT_NEAR(plane(seen, "", 0)[i], 1.0f, 1e-5f);
}

// Where nothing is hit, the sky gives way to the background; without a sky, nothing changes but alpha.
TEST_F(BackgroundTest, TakesThePlaceOfTheSky) {
    Scene scene = scene_from_above();
    for (const bool sky : {true, false}) {
        if (!sky) scene.environment.reset();
        for (const Backdrop backdrop : {Backdrop::background, Backdrop::transmitted}) {
            const Image seen = image(scene, backdrop, 4);
            expect_pixels(seen, vec3(0));
            EXPECT_EQ(mean_of(seen, "A"), 0.0);
        }
    }
}

// What reaches the camera otherwise is the same, sample by sample.
TEST_F(BackgroundTest, ChangesNoOtherLight) {
    Scene scene = scene_of_everything();
    scene.environment->visible = false;
    const auto states = [&](Backdrop backdrop) { return render(scene, settings_before(backdrop), 4); };
    const Image with = make_image(states(Backdrop::transmitted), {}, {});
    const Image without = make_image(states(Backdrop::environment), {}, {});
    size_t different = 0;
    for (size_t i = 0; i < with.pixel_count(); ++i) {
        const float a = plane(with, "", 1)[i], b = plane(without, "", 1)[i];
        EXPECT_LE(a, b + 1e-6f * b);  // Less by the sky behind glass.
        different += a != b;
    }
    EXPECT_LT(different, with.pixel_count() / 4);
}

}  // namespace
}  // namespace candela
