// The principled material in whole pictures: estimators agree, white bodies are invisible, without roughness
// it is the mirror and the glass that there were before, emission lies under its layers, culled sides are not
// there.
#include <random>

#include "estimator_fixture.h"

namespace candela {
namespace {

constexpr Medium CLEAR{};

class PrincipledPictureTest : public EstimatorTest {
  protected:
    // A unit sphere before an even white sky.
    static Scene sphere_of(const PrincipledMaterial& m) {
        Scene scene = scene_with_camera(dvec3(1, 2, 4.5), dvec3(0), 0.4f);
        scene.environment = constant_environment(vec3(1));
        add_shape(scene, Sphere{}, add_material(scene, m));
        return scene;
    }
    // The mean of the picture must be 1, within its noise.
    void expect_invisible(const Scene& scene, Estimator estimator, uint32_t spp) const {
        RenderSettings s = independent_settings(32, estimator, 9);
        s.rr_depth = 64;
        expect_mean(image_of(render(scene, s, samples(spp))), glm::dvec3(1.0), 0x1p-15);
    }
};

TEST_F(PrincipledPictureTest, EstimatorsAgree) {
    expect_estimators_agree(layered_scene(), 1024, 1024);
}

TEST_F(PrincipledPictureTest, WhiteBodiesAreInvisible) {
    const vec3 white(1);
    const std::vector<PrincipledMaterial> bodies{
        {.base_color = white, .metalness = 1.0f, .roughness = 0.8f},
        {.base_color = white, .metalness = 1.0f, .roughness = 0.6f, .anisotropy = 0.8f},
        {.base_color = white, .roughness = 1.0f},
        {.base_color = white, .roughness = 0.7f, .transmission = 1.0f},
        {.base_color = white, .roughness = 0.7f, .transmission = 1.0f, .inside = CLEAR},
        {.base_color = white, .roughness = 0.0f, .transmission = 1.0f, .inside = CLEAR, .dispersion = 2.0f},
        {.base_color = white,
         .roughness = 0.6f,
         .transmission = 0.5f,
         .inside = CLEAR,
         .diffuse_transmission = 0.5f},
        {.base_color = white, .metalness = 0.5f, .coat = 1.0f, .coat_roughness = 0.6f},
        {.base_color = white, .coat = 0.5f, .fuzz = 0.9f, .fuzz_roughness = 0.6f},
    };
    for (size_t i = 0; i < bodies.size(); ++i) {
        SCOPED_TRACE(i);
        expect_invisible(sphere_of(bodies[i]), Estimator::bsdf, 512);
    }
}

// 64 bodies of random materials beside each other, each a block of the picture: opaque, thin, solid, smooth
// and rough.
TEST_F(PrincipledPictureTest, RandomWhiteBodiesAreInvisible) {
    constexpr int ROW = 8;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const auto often = [&](float value) { return unit(random) < 0.5f ? value : 0.0f; };
    Scene scene = scene_with_camera(dvec3(0, 0, 10), dvec3(0), 0.4f);
    scene.cameras[0].ortho_height = 2.0 * ROW;
    scene.environment = constant_environment(vec3(1));
    for (int i = 0; i < ROW * ROW; ++i) {
        PrincipledMaterial m{.base_color = vec3(1),
                             .metalness = unit(random) < 0.3f ? unit(random) : 0.0f,
                             .roughness = often(unit(random)),
                             .ior = 1.0f + 1.2f * unit(random),
                             .anisotropy = often(unit(random)),
                             .transmission = i % 4 > 0 ? unit(random) : 0.0f,
                             .diffuse_transmission = often(unit(random)),
                             .coat = often(unit(random)),
                             .coat_roughness = often(unit(random)),
                             .fuzz = often(0.5f)};
        if (i % 4 > 1) m.inside = CLEAR;
        add_shape(scene, Sphere{dvec3(2 * (i % ROW) + 1 - ROW, 2 * (i / ROW) + 1 - ROW, 0), 0.9},
                  add_material(scene, m));
    }
    const uint32_t block = 8;
    RenderSettings s = independent_settings(ROW * block, Estimator::bsdf, 9);
    s.rr_depth = 64;
    const Image image = image_of(render(scene, s, samples(1024)));
    for (int i = 0; i < ROW * ROW; ++i) {
        double sum = 0.0, variance = 0.0;
        for (uint32_t p = 0; p < block * block; ++p) {
            const size_t pixel = (i / ROW * block + p / block) * s.size.x + i % ROW * block + p % block;
            sum += double(plane(image, "", 1)[pixel]);
            variance += double(plane(image, "Variance", 1)[pixel]);
        }
        const double mean = sum / (block * block), error = std::sqrt(variance) / (block * block);
        EXPECT_LE(error, 8.0 * largest_error()) << "body " << i;  // Of a 64th of the picture.
        const double beyond =
            std::max(0.0, std::abs(mean - 1.0) - 0x1p-12);  // Hundreds of vertices in glass.
        if (beyond == 0.0) continue;
        EXPECT_GT(normal_p_value(beyond / error), sidak_level(TEST_ALPHA, ROW * ROW))
            << "body " << i << ": " << mean << ", z = " << beyond / error;
    }
}

// What sheen leaves is a fit, at most 0.0023 off (bsdf/sheen_albedo.glsl): so much light is lost.
TEST_F(PrincipledPictureTest, WhiteClothIsNearlyInvisible) {
    for (const float roughness : {0.1f, 0.5f, 0.86f, 1.0f}) {
        const PrincipledMaterial cloth{
            .base_color = vec3(1), .roughness = 0.5f, .sheen_color = vec3(1), .sheen_roughness = roughness};
        RenderSettings s = independent_settings(32, Estimator::bsdf, 9);
        expect_mean(image_of(render(sphere_of(cloth), s, samples(512))), glm::dvec3(1.0), 0.0023);
    }
}

// Rough glass around rough glass around a white ball, with sheen and film where they reflect all light.
TEST_F(PrincipledPictureTest, NestedWhiteBodiesAreInvisible) {
    Scene scene = sphere_of(
        {.base_color = vec3(1), .roughness = 0.5f, .ior = 1.6f, .transmission = 1.0f, .inside = CLEAR});
    add_shape(scene, Sphere{dvec3(0.1, 0, 0), 0.7},
              add_material(scene, PrincipledMaterial{.base_color = vec3(1),
                                                     .roughness = 0.7f,
                                                     .ior = 1.2f,
                                                     .transmission = 1.0f,
                                                     .inside = Medium{vec3(0)},
                                                     .priority = 1}));
    add_shape(scene, Sphere{dvec3(0.2, 0.1, 0), 0.4}, add_diffuse(scene, vec3(1)));
    expect_invisible(scene, Estimator::bsdf, 1024);
}

// The same expectation, whichever name a scene uses.
TEST_F(PrincipledPictureTest, WithoutRoughnessItIsTheMirrorAndTheGlass) {
    const auto room = [](const auto& model) {
        Scene scene = open_room();
        add_shape(scene, Sphere{dvec3(0, 0.5, 0), 0.5}, add_material(scene, model));
        add_shape(scene, parallelogram(vec3(-0.5f, 1.5f, -0.2f), vec3(1, 0, 0), vec3(0, 0, 0.4f)),
                  add_diffuse(scene, vec3(0)), Emission{vec3(5), false});
        return scene;
    };
    const auto expect_same = [&](const auto& model, const PrincipledMaterial& m) {
        expect_same_expectation(image(room(model), settings(Estimator::mis, 1), 1024),
                                image(room(m), settings(Estimator::mis, 2), 1024));
    };
    expect_same(
        MirrorMaterial{vec3(0.9f, 0.8f, 0.7f)},
        PrincipledMaterial{
            .base_color = vec3(0.9f, 0.8f, 0.7f), .metalness = 1.0f, .roughness = 0.0f, .iridescence = 0.0f});
    const Medium green{vec3(2, 0.2f, 1)};
    expect_same(
        DielectricMaterial{.ior = 1.5f, .fresnel = Fresnel::exact, .inside = green},
        PrincipledMaterial{.base_color = vec3(1), .roughness = 0.0f, .transmission = 1.0f, .inside = green});
}

// A lamp seen head-on through an ideal coat of index n: 1 - ((n - 1) / (n + 1))^2 of its light.
TEST_F(PrincipledPictureTest, EmissionLiesUnderTheCoat) {
    Scene scene = scene_with_camera(dvec3(0, 0, 100), dvec3(0), 0.002f);
    const uint32_t coated = add_material(
        scene, PrincipledMaterial{.base_color = vec3(0), .specular = 0.0f, .coat = 0.5f, .coat_ior = 2.0f});
    add_shape(scene, parallelogram(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0)), coated,
              Emission{vec3(3), false});
    const Image seen = image_of(render(scene, independent_settings(8, Estimator::mis, 1), 4));
    for (const float value : plane(seen, "", 0))
        ASSERT_NEAR(value, 3.0 * (1.0 - 0.5 / 9.0), 1e-4);
}

TEST_F(PrincipledPictureTest, RaysPassCulledSides) {
    // A white floor under a lamp, and between them a screen that is culled from one side.
    const auto floor_under = [](bool front_up, bool double_sided) {
        Scene scene = floor_seen_closely(vec3(0.5f));
        PrincipledMaterial m{.base_color = vec3(0)};
        m.double_sided = double_sided;
        const uint32_t screen = add_material(scene, m);
        const vec3 along = front_up ? vec3(0, 0, -4) : vec3(0, 0, 4);
        add_shape(scene, parallelogram(vec3(-2, 2, front_up ? 2.0f : -2.0f), vec3(4, 0, 0), along), screen);
        add_shape(scene, parallelogram(vec3(-1, 3, -1), vec3(2, 0, 0), vec3(0, 0, 2)), 1,
                  Emission{vec3(4), false});
        return scene;
    };
    for (const Estimator estimator : {Estimator::light, Estimator::bsdf}) {
        RenderSettings s = independent_settings(16, estimator, 3);
        s.max_depth = 1;  // No light comes around the screen.
        const auto light = [&](const Scene& scene) {
            return image_mean(image_of(render(scene, s, samples(256))), 0).mean;
        };
        // Rays from the floor meet the side that is turned down first.
        EXPECT_EQ(light(floor_under(true, true)), 0.0);
        EXPECT_EQ(light(floor_under(false, true)), 0.0);
        EXPECT_EQ(light(floor_under(false, false)), 0.0);
        EXPECT_GT(light(floor_under(true, false)), 0.1);
    }
}

// A material takes the same light whether its values are numbers or come from an image, each from its
// channel; the direction of anisotropy, too.
TEST_F(PrincipledPictureTest, ValuesOfImagesAreThoseOfNumbers) {
    const auto picture = [](bool from_image) {
        Scene scene = scene_with_camera(dvec3(1, 2, 4.5), dvec3(0), 0.5f);
        scene.environment = one_bright_texel({8, 4}, {2, 1}, vec3(6, 5, 4));
        PrincipledMaterial m{.base_color = vec3(0.25f, 0.5f, 0.75f),
                             .metalness = 0.25f,
                             .roughness = 0.5f,
                             .specular = 0.75f,
                             .anisotropy = 0.75f,
                             .anisotropy_rotation = 1.25f,
                             .coat = 0.25f,
                             .coat_roughness = 0.5f,
                             .fuzz = 0.25f,
                             .fuzz_color = vec3(0.25f, 0.5f, 0.75f),
                             .fuzz_roughness = 0.5f};
        if (from_image) {
            const Texture image =
                add_texture(scene, {1, 1}, [](uint32_t, uint32_t) { return vec4(0.25f, 0.5f, 0.75f, 1.0f); });
            const auto channel = [&](uint32_t c) {
                Texture texture = image;
                texture.channel = c;
                return Textured<float>(1.0f, texture);
            };
            m.base_color = {vec3(1), image};
            m.fuzz_color = {vec3(1), image};
            m.metalness = m.coat = m.fuzz = channel(0);
            m.roughness = m.coat_roughness = m.fuzz_roughness = channel(1);
            m.specular = channel(2);
            // (0.25, 0.5) is the opposite of the tangent, and blue is 0.75 of the strength.
            m.anisotropy = 1.0f;
            m.anisotropy_rotation += float(M_PI);
            m.anisotropy_map = image;
        }
        add_shape(scene, Sphere{}, add_material(scene, m));
        // The colour of another model, from an image, leaves the place of this material's record alone.
        if (from_image) {
            PhongMaterial other{vec3(0), vec3(0.5f), 10.0f};
            other.specular.texture = add_texture(scene, {1, 1}, [](uint32_t, uint32_t) { return vec4(1); });
            add_material(scene, other);
        }
        return scene;
    };
    RenderSettings s = independent_settings(32, Estimator::mis, 5);
    const Image by_numbers = image_of(render(picture(false), s, 64)),
                by_image = image_of(render(picture(true), s, 64));
    for (size_t c = 0; c < 3; ++c) {
        const double mean = image_mean(by_numbers, c).mean;
        EXPECT_NEAR(image_mean(by_image, c).mean, mean, 1e-4 * mean);
    }
}

// Brushed metal under a small lamp has its highlight across the direction of its grooves: the tangent of a
// quad runs along u, and is turned towards v.
TEST_F(PrincipledPictureTest, HighlightsStretchAlongTheTurnedTangent) {
    const auto brightness = [&](float rotation, dvec3 lamp) {
        Scene scene = scene_with_camera(dvec3(0, 0, 100), dvec3(0), 0.001f);
        const uint32_t metal = add_material(scene, PrincipledMaterial{.base_color = vec3(1),
                                                                      .metalness = 1.0f,
                                                                      .roughness = 0.2f,
                                                                      .anisotropy = 0.8f,
                                                                      .anisotropy_rotation = rotation});
        add_shape(scene, parallelogram(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0)), metal);
        add_shape(scene, Sphere{lamp, 1.0}, add_diffuse(scene, vec3(0)), Emission{vec3(100), false});
        return image_mean(image_of(render(scene, independent_settings(8, Estimator::mis, 1), samples(64))), 0)
            .mean;
    };
    const double diagonal = std::sqrt(0.5) * 20;
    const dvec3 along_u(20, 0, 20), along_v(0, 20, 20), up(diagonal, diagonal, 20),
        down(diagonal, -diagonal, 20);
    EXPECT_GT(brightness(0.0f, along_u), 10 * brightness(0.0f, along_v));
    EXPECT_GT(brightness(float(M_PI / 4), up), 10 * brightness(float(M_PI / 4), down));
}

TEST_F(PrincipledPictureTest, UnlitSurfacesShowTheirColour) {
    Scene scene = scene_with_camera(dvec3(0, 0, 100), dvec3(0), 0.002f);
    PrincipledMaterial m{.base_color = vec3(0.25f, 0.5f, 0.75f)};
    m.unlit = true;
    add_shape(scene, parallelogram(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0)), add_material(scene, m));
    for (const bool lit : {false, true}) {
        if (lit) scene.environment = constant_environment(vec3(7));
        const Image seen = image_of(render(scene, independent_settings(8, Estimator::mis, 1), 4));
        for (size_t c = 0; c < 3; ++c) {
            for (const float value : plane(seen, "", c))
                ASSERT_EQ(value, 0.25f * float(c + 1));
        }
    }
}

}  // namespace
}  // namespace candela
