// The error that is estimated from one rendering is the one that comparison with a converged image shows.
#include "session/convergence.h"

#include <cmath>

#include "image/relative_error.h"
#include "load/load.h"
#include "scene/names.h"
#include "session/adaptive.h"
#include "steady_fixture.h"

namespace candela {
namespace {

class ConvergenceTest : public SteadyTest {
  protected:
    static constexpr uint32_t SIZE = 48, SPP = 128, REFERENCE_SPP = 1024;

    // The end of an adaptive rendering of SPP samples on average.
    ConvergencePoint adaptive_point(const Scene& scene, const GpuScene& gpu_scene,
                                    const Image& reference) const {
        const RenderSettings chosen = settings(SamplerKind::sobol, 1);
        SteadyRenderer renderer = steady_renderer(scene, gpu_scene, chosen, adaptive_states(chosen));
        uint32_t planned = 0;
        for (uint32_t end = 0; end < SPP;) {
            end = next_pass_end(end, SPP);
            EXPECT_TRUE(render_pass(renderer, end, planned, [](double) { return true; }));
        }
        Convergence convergence({}, reference);
        convergence.measure(renderer.states(), 1.0);
        return convergence.points().at(0);
    }
    static Image counted(const Accumulation& state) { return make_image(state, {.sample_count = true}, {}); }
    static RenderSettings settings(SamplerKind sampler, uint32_t seed) {
        RenderSettings s = settings_for(SIZE, SIZE);
        s.sampler = sampler;
        s.seed = seed;
        s.max_depth = 8;
        return s;
    }
};

// Bounds of estimate / error. Below: both are roots of means of 6912 squares, of which few pixels have most:
// with an effective number of 300, each has a standard deviation of 0.5 sqrt(2 / 300) = 0.041, their ratio of
// 0.058, and four of these are 0.23; the reference's own error adds 1/8 at most to the true square. Above: as
// much for samples that are independent in the end, as stratified ones are, too, in pairs of sets of 64; for
// Sobol points times sqrt(2^p - 1), where their variance falls as n^-p: with p = 1.5, sqrt(1.83) = 1.35. The
// darker of a pixel and its neighbours is at most a few standard deviations darker than the pixel, each as
// large as the error itself, which is below 0.1 here: 1.15.
TEST_F(ConvergenceTest, TheEstimatedErrorIsTheTrueOneForEverySampler) {
    for (const std::string name : {"cornell-box", "environment"}) {
        const Scene scene = load_scene(CANDELA_SCENES "/" + name + ".json");
        const GpuScene gpu_scene = build_gpu_scene(scene);
        const Image reference = counted(render(scene, settings(SamplerKind::sobol, 99), REFERENCE_SPP));
        for (const auto& [word, sampler] : SAMPLER_NAMES) {
            Renderer renderer(device(), gpu_scene, scene.cameras[0], settings(sampler, 1));
            const auto image_at = [&](uint32_t spp) {
                renderer.render(spp, [](double) { return true; });
                return counted(renderer.download());
            };
            const Image before = image_at(SPP / 2);
            const Image now = image_at(SPP);
            const double estimate = *estimate_relative_error(before, now);
            const double error = std::sqrt(relative_mse(*now.find_rgb(), *reference.find_rgb()));
            const double faster = sampler == SamplerKind::sobol ? 1.35 : 1.0;
            EXPECT_GT(estimate, error * 0.77 / std::sqrt(1.0 + 1.0 / 8.0)) << name << ", " << word;
            EXPECT_LT(estimate, error * 1.23 * 1.15 * faster) << name << ", " << word;
        }
        // With two halves nothing has to be assumed.
        const ConvergencePoint halves = adaptive_point(scene, gpu_scene, reference);
        const double error = std::sqrt(*halves.relmse);
        EXPECT_GT(*halves.estimate, error * 0.77 / std::sqrt(1.0 + 1.0 / 8.0)) << name;
        EXPECT_LT(*halves.estimate, error * 1.23 * 1.15) << name;
    }
}

}  // namespace
}  // namespace candela
