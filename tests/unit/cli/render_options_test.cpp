// What the options of `candela render` ask of a renderer.
#include "cli/render_options.h"

#include <gtest/gtest.h>

namespace candela {
namespace {

uint32_t pass_growth(const RenderOptions& options) {
    Scene scene;
    scene.cameras = {Camera{.name = {}, .lens = {}}};
    return options.job(scene).settings.pass_growth;
}

TEST(RenderOptions, PicturesThatMayBeTakenAtAnyTimeGrowEvenly) {
    RenderOptions options;
    EXPECT_EQ(pass_growth(options), PASS_GROWTH);
    options.outputs.write_every = 1.0;
    EXPECT_EQ(pass_growth(options), EVEN_PASS_GROWTH);
    options = RenderOptions{};
    options.stopping.time_limit = 1.0;
    EXPECT_EQ(pass_growth(options), EVEN_PASS_GROWTH);
}

TEST(RenderOptions, APictureHasTheSizeOfItsCameraUnlessTheCommandLineSaysOtherwise) {
    Scene scene;
    scene.film.size = {40, 30};
    scene.cameras = {Camera{.name = "first", .lens = {}},
                     Camera{.name = "second", .lens = {}, .film_size = uvec2(8, 6)}};
    RenderOptions options;
    EXPECT_EQ(options.job(scene).settings.size, uvec2(40, 30));
    EXPECT_EQ(options.job(scene, "second").settings.size, uvec2(8, 6));
    options.rendering.picture.size = uvec2(5, 5);
    EXPECT_EQ(options.job(scene, "second").settings.size, uvec2(5, 5));
}

// Cameras without a picture do not matter. The longer side is twice the height.
TEST(RenderOptions, AJobsCameraIsProjectedAndShifted) {
    Scene scene;
    scene.cameras = {Camera{.name = "first", .focal_ratio = 2.0f, .lens = {.radius = 1.0f}},
                     Camera{.name = "second", .ortho_height = 1.0, .lens = {}}};
    RenderOptions options;
    options.cameras.shift = glm::dvec2(0.25, 0.125);
    options.rendering.picture.size = uvec2(40, 20);
    EXPECT_EQ(options.job(scene).camera.principal_offset, vec2(-0.5f, 0.25f));
    EXPECT_EQ(options.job(scene).camera.lens.radius, 1.0f);
    EXPECT_THROW(options.job(scene, "second"), Error);
    options.cameras.projection = Panorama{Mapping::fisheye, 2.0f};
    for (const char* name : {"first", "second"}) {
        Camera expected{.name = name, .principal_offset = vec2(-0.5f, 0.25f), .lens = {}};
        expected.panorama = options.cameras.projection;
        EXPECT_EQ(options.job(scene, name).camera, expected) << name;
    }
}

TEST(RenderOptions, AJobIsTheSceneUnlessTheCommandLineSaysOtherwise) {
    Scene scene;
    scene.cameras = {Camera{.name = "first", .lens = {}}, Camera{.name = "second", .lens = {}}};
    scene.integrator = {.spp = 7, .max_depth = 5, .seed = 3};
    scene.film.size = {40, 30};
    RenderJob job = RenderOptions{}.job(scene);
    EXPECT_EQ(job.camera.name, "first");
    EXPECT_EQ(job.target, 7u);
    EXPECT_EQ(job.settings.size, uvec2(40, 30));
    EXPECT_EQ(job.settings.max_depth, 5u);
    EXPECT_EQ(job.settings.seed, 3u);

    RenderOptions options;
    options.rendering.sampling.spp = 12;
    options.rendering.sampling.seed = 4;
    options.rendering.sampling.max_depth = 6;
    options.rendering.picture.size = uvec2(8, 8);
    job = options.job(scene, "second");
    EXPECT_EQ(job.camera.name, "second");
    EXPECT_EQ(job.target, 12u);
    EXPECT_EQ(job.settings.size, uvec2(8, 8));
    EXPECT_EQ(job.settings.max_depth, 6u);
    EXPECT_EQ(job.settings.seed, 4u);
    options.rendering.sampling.spp.reset();
    options.stopping.samples = SampleRange{10, 25};
    EXPECT_EQ(options.job(scene).target, 15u);
    EXPECT_EQ(options.job(scene).settings.first_sample, 10u);
}

}  // namespace
}  // namespace candela
