// The variance that pictures report of themselves, where one light of many matters: a choice that seldom
// finds it reports a thousandth of the variance that repetitions show.
#include <algorithm>
#include <cmath>

#include "image/relative_error.h"
#include "probe/random.h"
#include "render_fixture.h"

namespace candela {
namespace {

constexpr uint32_t SIZE = 8, SEEDS = 30;

// A white wall at z = 0, of which the camera at that distance sees half as much.
Scene white_wall(double distance) {
    Scene scene = scene_with_camera(dvec3(0, 0, distance), dvec3(0), 0.5f);
    add_shape(scene, parallelogram(vec3(-4, -4, 0), vec3(8, 0, 0), vec3(0, 8, 0)),
              add_diffuse(scene, vec3(0.8f)));
    return scene;
}

// A square lamp that faces the wall, of that intensity towards it [W/sr].
void add_lamp(Scene& scene, vec3 center, float edge, float intensity) {
    const vec3 corner = center - 0.5f * vec3(edge, edge, 0);
    add_shape(scene, parallelogram(corner, vec3(0, edge, 0), vec3(edge, 0, 0)), add_diffuse(scene, vec3(0)),
              Emission{.radiance = vec3(intensity / (edge * edge))});
}

// A lamp of 10^-4 m at 5 cm from the wall, and one of 10^5 times its power at 50 m, which lights the wall a
// tenth as much.
Scene near_lamp() {
    Scene scene = white_wall(0.5);
    add_lamp(scene, vec3(0, 0, 0.05f), 1e-4f, 0.01f);
    add_lamp(scene, vec3(20, 0, 50), 1.0f, 1000.0f);
    return scene;
}

// A lamp of 2 cm at 30 cm from the wall, and 10^5 triangles from 20 to 100 m away, which together have a
// thousand times its power and light the wall a thirtieth as much.
Scene one_of_many() {
    Scene scene = white_wall(3.0);
    add_lamp(scene, vec3(0, 0, 0.3f), 0.02f, 0.08f);
    Random random(1);
    TriangleMesh mesh;
    for (int i = 0; i < 100'000; ++i) {
        const vec3 p =
            vec3(-50, -50, 20) + vec3(100, 100, 80) * vec3{random.unit(), random.unit(), random.unit()};
        add_triangle(mesh, p, p + vec3(0, 0.01f, 0), p + vec3(0.01f, 0, 0));
    }
    add_shape(scene, std::move(mesh), 0, Emission{.radiance = vec3(20)});
    return scene;
}

class VarianceTest : public RenderTest, public testing::WithParamInterface<Scene (*)()> {
  protected:
    static RenderSettings settings(SamplerKind sampler, uint32_t seed) {
        RenderSettings s = independent_settings(SIZE, Estimator::mis, seed);
        s.sampler = sampler;
        s.light_sampler = LightSampler::tree;
        s.max_depth = 1;
        return s;
    }
    // The next picture of the renderer, with `spp` samples in all.
    static Image render_to(Renderer& renderer, uint32_t spp) {
        EXPECT_TRUE(renderer.render(spp, [](double) { return true; }));
        return make_image(renderer.download(), {.variance = true, .sample_count = true}, {});
    }

    const Scene scene_ = GetParam()();
    const GpuScene gpu_scene_ = build_gpu_scene(scene_);
};

// The median picture predicts what the repetitions show. (The mean would: where few pictures find the light,
// these few predict for all.) The samples are independent: Sobol's vary less than they report.
TEST_P(VarianceTest, IsThatOfRepetitions) {
    constexpr uint32_t SPP = 64;
    Renderer renderer(device(), gpu_scene_, scene_.cameras[0], settings(SamplerKind::independent, 0));
    std::vector<RunningMoments> pixels(SIZE * SIZE);
    std::vector<double> predicted;
    for (uint32_t seed = 1; seed <= SEEDS; ++seed) {
        renderer.reset(gpu_scene_, scene_.cameras[0], settings(SamplerKind::independent, seed));
        const Image image = render_to(renderer, SPP);
        predicted.push_back(0.0);
        for (size_t i = 0; i < pixels.size(); ++i) {
            pixels[i].add(plane(image, "", 0)[i]);
            predicted.back() += double(plane(image, "Variance", 0)[i]);
        }
    }
    double seen = 0.0;
    for (const RunningMoments& pixel : pixels)
        seen += pixel.variance();
    std::ranges::nth_element(predicted, predicted.begin() + SEEDS / 2);
    EXPECT_GT(predicted[SEEDS / 2], 0.8 * seen);
    EXPECT_LT(predicted[SEEDS / 2], 1.3 * seen);
}

using SlowVarianceTest = VarianceTest;

// As --target-error does it: samples are doubled until the estimate is at most the target.
TEST_P(SlowVarianceTest, NoRenderingStopsFarAboveItsTargetError) {
    constexpr double TARGET = 0.3;
    RenderSettings by_tree = settings(SamplerKind::sobol, 0);
    by_tree.light_sampler = LightSampler::tree;
    Renderer renderer(device(), gpu_scene_, scene_.cameras[0], by_tree);
    const Image reference = render_to(renderer, 1u << 15);
    for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::independent}) {
        Renderer other(device(), gpu_scene_, scene_.cameras[0], settings(sampler, 0));
        for (uint32_t seed = 1; seed <= SEEDS; ++seed) {
            other.reset(gpu_scene_, scene_.cameras[0], settings(sampler, seed));
            uint32_t spp = MIN_ESTIMATED_SPP / 2;
            Image before = render_to(other, spp), now = render_to(other, spp *= 2);
            while (spp < 1u << 15 && estimate_relative_error(before, now).value() > TARGET) {
                before = std::move(now);
                now = render_to(other, spp *= 2);
            }
            EXPECT_LT(std::sqrt(relative_mse(*now.find_rgb(""), *reference.find_rgb(""))), 2.0 * TARGET)
                << seed;
        }
    }
}

const auto SCENES = testing::Values(near_lamp, one_of_many);

std::string name_of_scene(const testing::TestParamInfo<Scene (*)()>& tested) {
    return tested.index == 0 ? "NearLamp" : "OneOfMany";
}

INSTANTIATE_TEST_SUITE_P(Lights, VarianceTest, SCENES, name_of_scene);
INSTANTIATE_TEST_SUITE_P(Lights, SlowVarianceTest, SCENES, name_of_scene);

}  // namespace
}  // namespace candela
