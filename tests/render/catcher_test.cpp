// Catchers: what they catch against closed forms, and against pictures of the same surfaces rendered whole.
#include <cmath>
#include <cstring>

#include "base/color.h"
#include "film/catcher_layers.h"
#include "film/checkpoint.h"
#include "render/make_identity.h"
#include "render_fixture.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

constexpr float ALBEDO = 0.5f;

RenderSettings catching(RenderSettings settings, bool catchers = true) {
    settings.backdrop = Backdrop::background;
    settings.aovs = true;
    settings.catchers = catchers;
    return settings;
}

Image image_with_layers(const Accumulation& state) {
    return make_image(state, {.variance = true, .catchers = state.layer_count == LAYER_COUNT_CATCHERS}, {});
}

float at(const Image& image, const char* channel, size_t i) {
    return image.find(channel)->values[i];
}

// A floor at y = 0, far larger than what stands on it, under a sky of radiance 1. Material 0 is the floor's.
Scene floor_under_sky(Catcher catcher) {
    Scene scene = scene_with_camera(dvec3(0, 4, 8), dvec3(0, 0.8, 0), 0.5f);
    add_diffuse(scene, vec3(ALBEDO));
    scene.materials[0].catcher = catcher;
    add_shape(scene, parallelogram(vec3(-50, 0, 50), vec3(100, 0, 0), vec3(0, 0, -100)), 0);
    scene.environment = constant_environment(vec3(1));
    return scene;
}

// The same with a red ball, and with a lamp that gives it a sharper shadow.
Scene ball_on_floor(Catcher catcher) {
    Scene scene = floor_under_sky(catcher);
    add_shape(scene, Sphere{.center = dvec3(0, 1, 0), .radius = 1.0},
              add_diffuse(scene, vec3(0.8f, 0.2f, 0.1f)));
    add_shape(scene, parallelogram(vec3(-3, 5, -1), vec3(1, 0, 0), vec3(0, 0, 1)),
              add_diffuse(scene, vec3(0)), Emission{.radiance = vec3(20, 16, 12), .two_sided = true});
    return scene;
}

Scene without_ball(Scene scene) {
    scene.shapes.erase(scene.shapes.begin() + 1);
    return scene;
}

class CatcherTest : public RenderTest {
  protected:
    Image caught(const Scene& scene, uint32_t size, uint32_t spp, uint32_t seed, bool catchers = true) const {
        return image_with_layers(
            render(scene, catching(independent_settings(size, Estimator::mis, seed), catchers), spp));
    }
};

// A point sees a ball of radius r at the distance d, at the angle theta to its normal, in the fraction
// cos(theta) (r / d)^2 of the cosine-weighted hemisphere, if all of the ball is above its horizon. A black
// ball takes that from a sky that is the same everywhere.
TEST_F(CatcherTest, ABallTakesItsFormFactorFromAnEvenSky) {
    constexpr double HEIGHT = 2.0,
                     SHARE = HEIGHT / 11.180339887498949;  // d^3 = 5 sqrt(5) for a ball at (-1, 2, 0).
    Scene scene = floor_under_sky(Catcher::shadows);
    scene.cameras[0].position = dvec3(4, 1, 0);
    scene.cameras[0].look_at = dvec3(0);
    scene.cameras[0].ortho_height = 1e-3;
    add_shape(scene, Sphere{.center = dvec3(-1, HEIGHT, 0), .radius = 1.0}, add_diffuse(scene, vec3(0)));
    for (const Estimator estimator : ESTIMATORS) {
        const RenderSettings settings = catching(independent_settings(32, estimator, 5));
        const Image seen = image_with_layers(render(scene, settings, samples(64)));
        RunningMoments with, without;
        for (size_t i = 0; i < seen.pixel_count(); ++i) {
            with.add(plane(seen, "CatcherWith", 0)[i]);
            without.add(plane(seen, "CatcherWithout", 0)[i]);
            ASSERT_EQ(at(seen, "R", i), 0.0f);
            ASSERT_EQ(at(seen, CATCHER_ALPHA, i), 1.0f);
            ASSERT_EQ(at(seen, FOREGROUND_ALPHA, i), 0.0f);
            ASSERT_EQ(at(seen, FIRST_HIT_ALPHA, i), 0.0f);
        }
        EXPECT_NEAR(without.mean(), double(ALBEDO), 1e-6);  // Every direction shows the same sky.
        const double error = std::sqrt(with.variance_of_mean());
        EXPECT_LT(error, largest_error());
        const double z = (with.mean() - double(ALBEDO) * (1.0 - SHARE)) / error;
        EXPECT_GT(normal_p_value(z), TEST_ALPHA) << 1.0 - with.mean() / without.mean() << ", not " << SHARE;
    }
}

// In place of a holdout, the camera sees what is behind the picture: neither light nor alpha, however alpha
// is defined. All other pixels have the picture of the scene in which it is seen, with its shadow.
TEST_F(CatcherTest, AHoldoutIsAHoleInThePicture) {
    Scene scene = ball_on_floor(Catcher::none);
    const Scene seen_whole = scene;
    scene.materials[1].catcher = Catcher::holdout;  // The ball's.
    for (const Backdrop backdrop : {Backdrop::background, Backdrop::transmitted}) {
        RenderSettings settings = catching(independent_settings(32, Estimator::mis, 3));
        settings.backdrop = backdrop;
        const AovSelection layers{
            .albedo = true, .transmission = backdrop == Backdrop::transmitted, .catchers = true};
        const Image image = make_image(render(scene, settings, 16), layers, {});
        settings.catchers = false;
        const Image whole = make_image(render(seen_whole, settings, 16),
                                       {.albedo = true, .transmission = layers.transmission}, {});
        size_t holes = 0, others = 0;
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const float albedo = plane(whole, "Albedo", 0)[i];
            if (albedo > 0.79f) {  // All of the pixel is the ball.
                for (size_t c = 0; c < 3; ++c)
                    ASSERT_EQ(plane(image, "", c)[i], 0.0f);
                ASSERT_EQ(at(image, "A", i), 0.0f);
                ++holes;
            } else if (albedo == ALBEDO) {
                for (size_t c = 0; c < 3; ++c)
                    ASSERT_EQ(plane(image, "", c)[i], plane(whole, "", c)[i]);
                ASSERT_EQ(at(image, "A", i), at(whole, "A", i));
                ++others;
            }
        }
        EXPECT_GT(holes, 50u);
        EXPECT_GT(others, 500u);
    }
}

// A holdout belongs to the real place: a catcher shows no shadow of it.
TEST_F(CatcherTest, HoldoutsShadeNoCatchers) {
    Scene scene = ball_on_floor(Catcher::shadows);
    scene.materials[1].catcher = Catcher::holdout;
    const Image image = caught(scene, 32, 8, 1);
    for (size_t i = 0; i < image.pixel_count(); ++i)
        ASSERT_EQ(at(image, "A", i), at(image, FOREGROUND_ALPHA, i));
}

// Both paths of a sample are then the same, with the same bits.
TEST_F(CatcherTest, NothingButCatchersLightsAndSkyLeavesNoShadow) {
    for (const Catcher catcher : {Catcher::shadows, Catcher::reflections}) {
        const Image seen = caught(without_ball(ball_on_floor(catcher)), 32, 8, 1);
        size_t of_floor = 0;
        for (size_t i = 0; i < seen.pixel_count(); ++i) {
            for (size_t c = 0; c < 3; ++c)
                ASSERT_EQ(plane(seen, "CatcherWith", c)[i], plane(seen, "CatcherWithout", c)[i]);
            ASSERT_EQ(at(seen, "A", i), at(seen, FOREGROUND_ALPHA, i));
            of_floor += at(seen, CATCHER_ALPHA, i) == 1.0f;
        }
        EXPECT_GT(of_floor, 500u);
    }
}

// What the floor scatters with everything there is the same path as that of an ordinary floor.
TEST_F(CatcherTest, WithIsTheOrdinarySurface) {
    const Image seen = caught(ball_on_floor(Catcher::shadows), 32, 16, 2);
    const Image whole = caught(ball_on_floor(Catcher::shadows), 32, 16, 2, false);
    EXPECT_EQ(whole.find(CATCHER_ALPHA), nullptr);
    for (size_t i = 0; i < seen.pixel_count(); ++i) {
        for (size_t c = 0; c < 3; ++c) {
            const float light = plane(whole, "", c)[i];
            ASSERT_NEAR(plane(seen, "", c)[i] + plane(seen, "CatcherWith", c)[i], light,
                        1e-5f * (1.0f + light));
        }
    }
}

// Before a photograph of the empty floor (here, a rendering with many samples), in colour, the layers make
// the picture that has everything in it: pixel by pixel, the differences have the mean 0. A ratio of means of
// n samples is off by about its relative variance, 1 / n; with 256 samples, this is far below the noise of a
// block.
TEST_F(CatcherTest, CompositesAreThePictureRenderedWhole) {
    constexpr uint32_t SIZE = 32, BLOCK = 8;
    const uint32_t spp = samples(256);
    const Image empty = caught(without_ball(ball_on_floor(Catcher::none)), SIZE, 16 * spp, 3, false);
    const Image whole = caught(ball_on_floor(Catcher::none), SIZE, spp, 4, false);
    for (const Catcher catcher : {Catcher::shadows, Catcher::reflections}) {
        SCOPED_TRACE(int(catcher));
        const Image seen = caught(ball_on_floor(catcher), SIZE, spp, 5);
        double deepest = 0.0, reflected = 0.0;
        for (uint32_t block = 0; block < (SIZE / BLOCK) * (SIZE / BLOCK); ++block) {
            const uint32_t x0 = block % (SIZE / BLOCK) * BLOCK, y0 = block / (SIZE / BLOCK) * BLOCK;
            for (size_t c = 0; c < 3; ++c) {
                RunningMoments differences;
                for (uint32_t k = 0; k < BLOCK * BLOCK; ++k) {
                    const size_t i = size_t(y0 + k / BLOCK) * SIZE + x0 + k % BLOCK;
                    // Only pixels of the floor alone: of others, the photograph does not say what the floor's
                    // part is.
                    if (at(seen, CATCHER_ALPHA, i) != 1.0f) continue;
                    const double ratio = double(plane(seen, "CatcherWith", c)[i]) /
                                         double(plane(seen, "CatcherWithout", c)[i]);
                    const double light = double(plane(seen, "", c)[i]);
                    differences.add(light + ratio * double(plane(empty, "", c)[i]) -
                                    double(plane(whole, "", c)[i]));
                    deepest = std::max(deepest, 1.0 - ratio);
                    reflected = std::max(reflected, light);
                }
                if (differences.count() < BLOCK * BLOCK / 2) continue;
                const double t = differences.mean() / std::sqrt(differences.variance_of_mean());
                EXPECT_GT(student_t_p_value(t, double(differences.count() - 1)), TEST_ALPHA)
                    << "block " << block << ", channel " << c << ": t = " << t;
            }
        }
        EXPECT_GT(deepest, 0.5);
        EXPECT_EQ(reflected > 0.05, catcher == Catcher::reflections);
    }
}

// The part of a floor that reflects which has not met the ball is darker than all that it scatters, and no
// brighter than without the ball; what it reflects of the ball is red.
TEST_F(CatcherTest, ReflectionsAreLightThatHasMetTheRest) {
    const Image all = caught(ball_on_floor(Catcher::shadows), 32, 16, 6);
    const Image parts = caught(ball_on_floor(Catcher::reflections), 32, 16, 6);
    double red = 0.0, blue = 0.0;
    for (size_t i = 0; i < all.pixel_count(); ++i) {
        if (at(all, CATCHER_ALPHA, i) != 1.0f) continue;
        for (size_t c = 0; c < 3; ++c) {
            const float with = plane(parts, "CatcherWith", c)[i], reflected = plane(parts, "", c)[i];
            ASSERT_NEAR(with + reflected, plane(all, "CatcherWith", c)[i], 1e-5f * (1.0f + with));
            ASSERT_LE(with, plane(parts, "CatcherWithout", c)[i] * (1.0f + 1e-6f));
        }
        ASSERT_EQ(at(parts, FIRST_HIT_ALPHA, i), 1.0f);
        red += double(plane(parts, "", 0)[i]);
        blue += double(plane(parts, "", 2)[i]);
    }
    EXPECT_GT(red, 3.0 * blue);
    EXPECT_GT(blue, 0.0);
}

// The background is seen through a catcher, also where glass lets it pass; through glass, a catcher is a
// surface.
TEST_F(CatcherTest, AlphaIsThatOfTheShadowAndOfEverythingElse) {
    Scene scene = ball_on_floor(Catcher::shadows);
    scene.materials[1].model = DielectricMaterial{.ior = 1.5f};
    RenderSettings settings = catching(independent_settings(32, Estimator::mis, 7));
    settings.backdrop = Backdrop::transmitted;
    const Image seen = make_image(render(scene, settings, 16), {.transmission = true, .catchers = true}, {});
    size_t shadows = 0, glass = 0;
    for (size_t i = 0; i < seen.pixel_count(); ++i) {
        const auto colour = [&](const char* layer) {
            return vec3(plane(seen, layer, 0)[i], plane(seen, layer, 1)[i], plane(seen, layer, 2)[i]);
        };
        const float without = luminance(colour("CatcherWithout")), share = at(seen, CATCHER_ALPHA, i);
        const float passed =
            without > 0.0f ? std::min(luminance(colour("CatcherWith")) / without, 1.0f) : 1.0f;
        ASSERT_NEAR(at(seen, "A", i), at(seen, FOREGROUND_ALPHA, i) + share * (1.0f - passed), 1e-6f);
        if (share == 1.0f) {
            ASSERT_EQ(at(seen, FOREGROUND_ALPHA, i), 0.0f);
        }
        shadows += share == 1.0f && passed < 0.9f;
        glass += share == 0.0f && at(seen, FOREGROUND_ALPHA, i) > 0.5f;
    }
    EXPECT_GT(shadows, 10u);
    EXPECT_GT(glass, 30u);
}

TEST_F(CatcherTest, CropsAndContinuedRenderingsHaveTheSameBits) {
    constexpr uint32_t SPP = 12;
    const GpuScene scene = build_gpu_scene(ball_on_floor(Catcher::reflections));
    const Camera camera = ball_on_floor(Catcher::none).cameras[0];
    RenderSettings settings = catching(settings_for(37, 23));
    const Accumulation whole = render(scene, camera, settings, SPP);
    EXPECT_EQ(whole.layer_count, LAYER_COUNT_CATCHERS);

    const TemporaryDirectory directory;
    Renderer first(device(), scene, camera, settings);
    ASSERT_TRUE(first.render(5, [](double) { return true; }));
    const Accumulation half = first.download();
    save_checkpoint(directory / "half.exr", {.identity = make_identity(scene, camera, settings), .maker = {}},
                    {&half, 1});
    settings.submission_seconds = 1e-6;
    Renderer second(device(), scene, camera, settings);
    second.upload(load_checkpoint(directory / "half.exr").states.at(0));
    ASSERT_TRUE(second.render(SPP, [](double) { return true; }));
    const Accumulation continued = second.download();
    ASSERT_EQ(continued.values.size(), whole.values.size());
    EXPECT_EQ(std::memcmp(continued.values.data(), whole.values.data(), whole.values.size() * sizeof(float)),
              0);

    settings.crop = {5, 3, 24, 20};
    const Accumulation part = render(scene, camera, settings, SPP);
    for (uint32_t layer = 0; layer < LAYER_COUNT_CATCHERS; ++layer) {
        for (uint32_t y = settings.crop.y0; y < settings.crop.y1; ++y) {
            ASSERT_EQ(std::memcmp(part.at(layer, size_t(y - settings.crop.y0) * settings.crop.width()),
                                  whole.at(layer, size_t(y) * 37 + settings.crop.x0),
                                  settings.crop.width() * 4 * sizeof(float)),
                      0)
                << layer << ' ' << y;
        }
    }
}

// Whatever settings say of catchers, a scene without any has the same constants, and the kernel that it had.
TEST_F(CatcherTest, ScenesWithoutCatchersKeepTheirKernel) {
    const Scene scene = ball_on_floor(Catcher::none);
    const GpuScene records = build_gpu_scene(scene);
    EXPECT_FALSE(records.has_catchers);
    RenderSettings settings = settings_for(8, 8);
    settings.aovs = settings.catchers = true;
    const KernelConstants constants = make_constants(records, scene.cameras[0], settings);
    EXPECT_EQ(constants[CONSTANT_CATCHERS], CATCHERS_NONE);
    const Scene with = ball_on_floor(Catcher::shadows);
    EXPECT_EQ(make_constants(build_gpu_scene(with), with.cameras[0], settings_for(8, 8))[CONSTANT_CATCHERS],
              CATCHERS_SHOWN);
}

}  // namespace
}  // namespace candela
