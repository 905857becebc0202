// What guides denoisers: albedo and normal behind mirrors and glass, against closed forms.
#include <cmath>
#include <cstring>

#include "film/checkpoint.h"
#include "render/make_identity.h"
#include "render_fixture.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

constexpr vec3 TINT(0.9f, 0.6f, 0.3f);
constexpr uint32_t SIZE = 16;

// A camera at z = 3 looks down -z, by parallel rays, at a surface of the plane z = 0 with that material.
// Behind the camera, at z = 6, is a wall that faces it; nothing emits.
Scene wall_in(const decltype(Material::model)& material) {
    Scene scene = scene_with_camera(dvec3(0, 0, 3), dvec3(0), 0.5f);
    scene.cameras[0].ortho_height = 1.0;
    add_shape(scene, parallelogram(vec3(-2, -2, 0), vec3(4, 0, 0), vec3(0, 4, 0)),
              add_material(scene, material));
    add_shape(scene, parallelogram(vec3(-2, 2, 6), vec3(4, 0, 0), vec3(0, -4, 0)),
              add_diffuse(scene, REFLECTANCE));
    return scene;
}

RenderSettings guided(RenderSettings settings) {
    settings.guides = true;
    return settings;
}

class GuidesTest : public RenderTest {
  protected:
    Image guides(const Scene& scene, uint32_t spp = 4,
                 RenderSettings settings = settings_for(SIZE, SIZE)) const {
        return make_image(render(scene, guided(settings), spp), {.denoising = true}, {});
    }

    static vec3 albedo(const Image& image, size_t i) {
        return {plane(image, "DenoisingAlbedo", 0)[i], plane(image, "DenoisingAlbedo", 1)[i],
                plane(image, "DenoisingAlbedo", 2)[i]};
    }
    static vec3 normal(const Image& image, size_t i) {
        return {image.find("DenoisingNormal.X")->values[i], image.find("DenoisingNormal.Y")->values[i],
                image.find("DenoisingNormal.Z")->values[i]};
    }

    // Every pixel has this albedo, up to the rounding of three factors and a mean, and this normal.
    static void expect_everywhere(const Image& image, vec3 expected_albedo, vec3 expected_normal) {
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(albedo(image, i)[c], expected_albedo[c], 8 * 0x1p-24f) << i;
                ASSERT_EQ(normal(image, i)[c], expected_normal[c]) << i;
            }
        }
    }
};

TEST_F(GuidesTest, AMirrorShowsTheTintedAlbedoOfWhatIsInIt) {
    expect_everywhere(guides(wall_in(MirrorMaterial{TINT})), TINT * REFLECTANCE, vec3(0, 0, -1));
    // Gold leaf: a principled metal whose facets are ideal; its reflectance at normal incidence is its
    // colour.
    const PrincipledMaterial metal{.base_color = TINT, .metalness = 1.0f, .roughness = 0.0f};
    expect_everywhere(guides(wall_in(metal)), TINT * REFLECTANCE, vec3(0, 0, -1));
}

TEST_F(GuidesTest, DiffuseAndRoughSurfacesAreTheirOwnGuides) {
    expect_everywhere(guides(wall_in(DiffuseMaterial{TINT})), TINT, vec3(0, 0, 1));
    expect_everywhere(guides(wall_in(ConductorMaterial{TINT, 0.3f})), TINT, vec3(0, 0, 1));
    const PrincipledMaterial rough{.base_color = TINT, .metalness = 1.0f, .roughness = 0.6f};
    expect_everywhere(guides(wall_in(rough)), TINT, vec3(0, 0, 1));
}

// Polished plastic reflects 4 % of the light ideally, the rest diffusely: that is what it looks like.
TEST_F(GuidesTest, AMixtureIsWhatMostOfItsLightIs) {
    const PrincipledMaterial plastic{.base_color = TINT, .roughness = 0.0f};
    expect_everywhere(guides(wall_in(plastic)), TINT, vec3(0, 0, 1));
}

// At normal incidence glass reflects R = ((n - 1) / (n + 1))^2 of the light to the wall, and the rest meets a
// floor of another colour behind it, through a medium that absorbs: each sample is one or the other. The
// share of R is a binomial mean over all samples.
TEST_F(GuidesTest, GlassShowsWhatItReflectsAndTransmitsInTheirShares) {
    constexpr double R = 0.04;
    constexpr vec3 BEHIND(0.25f, 0.5f, 0.75f);
    constexpr float DEPTH = 0.5f;
    Scene scene = wall_in(DielectricMaterial{.ior = 1.5f, .inside = {ABSORPTION}});
    add_shape(scene, parallelogram(vec3(-2, -2, -DEPTH), vec3(4, 0, 0), vec3(0, 4, 0)),
              add_diffuse(scene, BEHIND));
    RenderSettings settings = independent_settings(64, Estimator::mis, 3);
    const uint32_t spp = samples(64);
    const Image image = guides(scene, spp, settings);
    RunningMoments reflected;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        // Of the wall, normals point to -z, and to z of what is behind the glass.
        const double share = 0.5 * (1.0 - double(normal(image, i).z));
        reflected.add(share);
        double contrast = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double through = double(BEHIND[c]) * std::exp(-double(ABSORPTION[c] * DEPTH));
            ASSERT_NEAR(double(albedo(image, i)[c]), share * double(REFLECTANCE[c]) + (1.0 - share) * through,
                        1e-5);
            contrast += std::pow(through - double(REFLECTANCE[c]), 2.0);
        }
        // Of samples that are one of two values; floats hold their squares to 2^-24.
        ASSERT_NEAR(double(image.find("DenoisingAlbedo.V")->values[i]),
                    share * (1.0 - share) * contrast / double(spp - 1), 4 * 0x1p-24);
    }
    const double error = std::sqrt(R * (1.0 - R) / (double(spp) * double(image.pixel_count())));
    EXPECT_GT(normal_p_value((reflected.mean() - R) / error), TEST_ALPHA) << reflected.mean();
}

// After ideal scattering a path survives with the probability 0.99, and its throughput grows by 1 / 0.99; the
// tint does not. One that ends at the mirror leaves the mirror's own albedo.
TEST_F(GuidesTest, RussianRouletteDoesNotChangeTheTint) {
    RenderSettings settings = independent_settings(64, Estimator::mis, 1);
    settings.rr_depth = 0;
    const Image image = guides(wall_in(MirrorMaterial{TINT}), 1, settings);
    size_t ended = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const bool goes_on = normal(image, i).z < 0.0f;
        const vec3 expected = goes_on ? TINT * REFLECTANCE : TINT;
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(albedo(image, i)[c], expected[c], 4 * 0x1p-24f);
        ended += !goes_on;
    }
    EXPECT_GT(ended, 0u);
    EXPECT_LT(ended, image.pixel_count() / 20);
}

TEST_F(GuidesTest, WhatEmitsIsAsBrightAsAScreenCanShow) {
    Scene scene = wall_in(DiffuseMaterial{vec3(0.1f, 0.2f, 0.3f)});
    scene.shapes[0].emission = Emission{.radiance = vec3(0.5f, 20, 0)};
    expect_everywhere(guides(scene), vec3(0.6f, 1, 0.3f), vec3(0, 0, 1));
}

TEST_F(GuidesTest, TheSkyIsItsRadianceWithoutANormalAndNothingIsBlack) {
    Scene scene = wall_in(MirrorMaterial{TINT});
    scene.shapes.pop_back();
    expect_everywhere(guides(scene), vec3(0), vec3(0));
    scene.environment = constant_environment(vec3(0.5f, 0.25f, 3));
    expect_everywhere(guides(scene), TINT * vec3(0.5f, 0.25f, 1), vec3(0));
    scene.shapes.clear();
    add_shape(scene, Sphere{.center = dvec3(0, 0, 50), .radius = 1.0}, 0);
    expect_everywhere(guides(scene), vec3(0.5f, 0.25f, 1), vec3(0));
}

TEST_F(GuidesTest, APathThatMayNotGoOnEndsWithWhatItMetLast) {
    RenderSettings settings = settings_for(SIZE, SIZE);
    settings.max_depth = 0;
    expect_everywhere(guides(wall_in(MirrorMaterial{TINT}), 4, settings), TINT, vec3(0, 0, 1));
}

// A catcher is rendered by two paths per sample; the first one, which sees everything, guides.
Scene mirror_ball_on_catcher() {
    Scene scene = scene_with_camera(dvec3(0, 4, 8), dvec3(0, 0.8, 0), 0.5f);
    add_diffuse(scene, vec3(0.5f));
    scene.materials[0].catcher = Catcher::reflections;
    add_shape(scene, parallelogram(vec3(-50, 0, 50), vec3(100, 0, 0), vec3(0, 0, -100)), 0);
    add_shape(scene, Sphere{.center = dvec3(0, 1, 0), .radius = 1.0},
              add_material(scene, MirrorMaterial{TINT}));
    scene.environment = constant_environment(vec3(1));
    return scene;
}

// Colour alone, with albedo and normals, with catchers: the layers of guides follow them.
std::vector<RenderSettings> all_sets_of_layers(RenderSettings settings) {
    std::vector<RenderSettings> all(3, guided(settings));
    all[1].aovs = all[2].aovs = true;
    all[2].catchers = true;
    all[2].backdrop = Backdrop::background;
    return all;
}

TEST_F(GuidesTest, CropsAndContinuedRenderingsHaveTheSameBits) {
    constexpr uint32_t SPP = 12;
    const GpuScene scene = build_gpu_scene(mirror_ball_on_catcher());
    const Camera camera = mirror_ball_on_catcher().cameras[0];
    for (RenderSettings settings : all_sets_of_layers(settings_for(37, 23))) {
        const uint32_t first_layer = layers_before_guides(settings);
        SCOPED_TRACE(first_layer);
        const Accumulation whole = render(scene, camera, settings, SPP);
        ASSERT_EQ(whole.denoising_layer, first_layer);
        ASSERT_EQ(whole.layer_count, first_layer + LAYER_COUNT_GUIDES);

        const TemporaryDirectory directory;
        Renderer first(device(), scene, camera, settings);
        ASSERT_TRUE(first.render(5, [](double) { return true; }));
        const Accumulation half = first.download();
        save_checkpoint(directory / "half.exr",
                        {.identity = make_identity(scene, camera, settings), .maker = {}}, {&half, 1});
        settings.submission_seconds = 1e-6;
        Renderer second(device(), scene, camera, settings);
        second.upload(load_checkpoint(directory / "half.exr").states.at(0));
        ASSERT_TRUE(second.render(SPP, [](double) { return true; }));
        EXPECT_TRUE(second.download().values == whole.values);

        settings.crop = {5, 3, 24, 20};
        const Accumulation part = render(scene, camera, settings, SPP);
        for (uint32_t layer = 0; layer < whole.layer_count; ++layer) {
            for (uint32_t y = settings.crop.y0; y < settings.crop.y1; ++y) {
                ASSERT_EQ(std::memcmp(part.at(layer, size_t(y - settings.crop.y0) * settings.crop.width()),
                                      whole.at(layer, size_t(y) * 37 + settings.crop.x0),
                                      settings.crop.width() * 4 * sizeof(float)),
                          0)
                    << layer << ' ' << y;
            }
        }
    }
}

// Guides are seen, and change no bit of the rest, nor the identity.
TEST_F(GuidesTest, TheOtherLayersKeepTheirBits) {
    const GpuScene scene = build_gpu_scene(mirror_ball_on_catcher());
    const Camera camera = mirror_ball_on_catcher().cameras[0];
    for (const RenderSettings& settings : all_sets_of_layers(settings_for(37, 23))) {
        RenderSettings without = settings;
        without.guides = false;
        EXPECT_EQ(make_identity(scene, camera, settings).hash, make_identity(scene, camera, without).hash);
        EXPECT_EQ(make_constants(scene, camera, without)[CONSTANT_DENOISING_LAYER], 0u);
        const Accumulation with_guides = render(scene, camera, settings, 4);
        const Accumulation plain = render(scene, camera, without, 4);
        ASSERT_EQ(plain.layer_count, with_guides.denoising_layer);
        EXPECT_EQ(
            std::memcmp(plain.values.data(), with_guides.values.data(), plain.values.size() * sizeof(float)),
            0);
        // The catcher's albedo, also where the second path of a sample sees nothing else.
        const Image image = make_image(with_guides, {.denoising = true}, {});
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(albedo(image, image.pixel_count() - 1)[c], 0.5f, 0x1p-24f);
    }
}

}  // namespace
}  // namespace candela
