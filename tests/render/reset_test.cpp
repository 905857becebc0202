// A renderer that begins anew with another camera or other settings: the picture is what a fresh one would
// make.
#include <limits>

#include "load/load.h"
#include "render/render_fixture.h"

namespace candela {
namespace {

bool go_on(double) {
    return true;
}

class ResetTest : public RenderTest {
  protected:
    ResetTest()
        : scene_(load_scene(CANDELA_SCENES "/depth-of-field.json")), gpu_scene_(build_gpu_scene(scene_)) {}

    // Resets the renderer, which has some samples, and compares it with a fresh one, bit for bit.
    void expect_as_fresh(Renderer& renderer, const Camera& camera, const RenderSettings& settings) {
        renderer.reset(gpu_scene_, camera, settings);
        Renderer fresh(device(), gpu_scene_, camera, settings);
        for (Renderer* one : {&renderer, &fresh})
            EXPECT_TRUE(one->render(3, go_on));
        const Accumulation a = renderer.download();
        const Accumulation b = fresh.download();
        EXPECT_EQ(a.full, b.full);
        EXPECT_EQ(a.layer_count, b.layer_count);
        EXPECT_EQ(a.total_samples(), 3 * a.pixel_count());
        EXPECT_TRUE(a.values == b.values);
        EXPECT_EQ(renderer.counters().rays, fresh.counters().rays);
    }

    Scene scene_;
    GpuScene gpu_scene_;
};

TEST_F(ResetTest, GivesThePictureOfAFreshRendererAndCompilesOnlyForOtherConstants) {
    Camera camera = scene_.cameras.at(0);
    RenderSettings settings = settings_for(24, 16);
    Renderer renderer(device(), gpu_scene_, camera, settings);
    ASSERT_TRUE(renderer.render(2, go_on));
    // Wall time is measured to the nanosecond: if the kernel were compiled anew, this number would change.
    const double compiled = renderer.pipeline_seconds();

    camera.position += vec3(0.3f, 0.2f, 0.1f);
    camera.lens.focal_distance *= 1.5f;
    camera.lens.radius *= 2.0f;
    expect_as_fresh(renderer, camera, settings);
    settings = settings_for(40, 12);
    settings.max_depth = 1;
    settings.seed = 5;
    gpu_scene_.environment_rotation += 1.0f;
    expect_as_fresh(renderer, camera, settings);
    EXPECT_EQ(renderer.pipeline_seconds(), compiled);

    camera.lens.radius = 0.0f;
    settings.estimator = Estimator::bsdf;
    settings.aovs = true;
    expect_as_fresh(renderer, camera, settings);
    EXPECT_NE(renderer.pipeline_seconds(), compiled);
}

// Into a ball of tinted glass, as a viewer may go.
TEST_F(ResetTest, TheMediaAroundTheCameraAreThoseOfItsPlace) {
    scene_.environment = constant_environment(vec3(1));
    add_shape(scene_, Sphere{dvec3(10, 10, 10), 2.0},
              add_material(scene_, DielectricMaterial{.inside = {vec3(1, 2, 3)}}));
    gpu_scene_ = build_gpu_scene(scene_);
    ASSERT_FALSE(gpu_scene_.nested_media);
    Camera camera = scene_.cameras.at(0);
    const RenderSettings settings = settings_for(24, 16);
    Renderer renderer(device(), gpu_scene_, camera, settings);
    ASSERT_TRUE(renderer.render(2, go_on));
    for (const dvec3 place : {dvec3(10, 11, 10), dvec3(10, 13, 10), dvec3(9, 10, 10)}) {
        camera.position = place;
        expect_as_fresh(renderer, camera, settings);
    }
}

TEST_F(ResetTest, ALatencyHoldsForOnePicture) {
    RenderSettings settings = settings_for(64, 64);
    settings.submission_seconds = 1000.0;
    Renderer renderer(device(), gpu_scene_, scene_.cameras.at(0), settings);
    const auto submissions = [&](double latency) {
        RenderSettings changed = settings;
        changed.submission_seconds = 0.0;  // As before.
        changed.latency = latency;
        renderer.reset(gpu_scene_, scene_.cameras.at(0), changed);
        int count = 0;
        EXPECT_TRUE(renderer.render(4, [&](double) {
            ++count;
            return true;
        }));
        return count;
    };
    const int unhurried = submissions(std::numeric_limits<double>::infinity());
    EXPECT_GT(submissions(1e-6), 32);  // A work group at a time, after the first submission.
    EXPECT_LE(unhurried, 4);
    EXPECT_EQ(submissions(std::numeric_limits<double>::infinity()), unhurried);
}

}  // namespace
}  // namespace candela
