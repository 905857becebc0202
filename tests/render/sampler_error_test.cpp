// Sobol points are worth it on every scene: at 2^k samples a pixel, their error is no greater than that of
// independent samples.
#include <cmath>

#include "load/load.h"
#include "render_fixture.h"

namespace candela {
namespace {

class SamplerErrorTest : public RenderTest {
  protected:
    static constexpr uint32_t WIDTH = 96, HEIGHT = 72, SPP = 16, REFERENCE_SPP = 128;

    Image image(const Scene& scene, SamplerKind sampler, uint32_t seed, uint32_t spp) const {
        RenderSettings s = settings_for(WIDTH, HEIGHT);
        s.sampler = sampler;
        s.seed = seed;
        s.max_depth = 8;
        return image_of(render(scene, s, spp));
    }
};

// Squared errors of an image, one for each of 16 replicates. The samples of a pixel are independent of those
// of all others, for every sampler (SamplerStatisticsTest); so the 16 pixels of a block 4 x 4 are replicates
// like 16 seeds, each of which would have to compile a kernel of its own. Colours are first mapped to x / (1
// + x), so that the few brightest samples do not decide.
RunningMoments squared_errors(const Image& image, const Image& reference) {
    constexpr size_t BLOCK = 4;
    const auto bounded = [](float x) { return double(x) / (1.0 + double(x)); };
    std::vector<RunningMoments> replicates(BLOCK * BLOCK);
    for (const size_t c : {0u, 1u, 2u}) {
        const std::span<const float> values = plane(image, "", c), expected = plane(reference, "", c);
        for (size_t i = 0; i < values.size(); ++i) {
            const size_t x = i % image.data.width(), y = i / image.data.width();
            const double error = bounded(values[i]) - bounded(expected[i]);
            replicates[y % BLOCK * BLOCK + x % BLOCK].add(error * error);
        }
    }
    RunningMoments errors;
    for (const RunningMoments& replicate : replicates)
        errors.add(replicate.mean());
    return errors;
}

// One-sided, by Student's test of the difference; the replicates give its error. What the reference lacks in
// convergence (it has 8 times as many samples) adds to both errors alike.
TEST_F(SamplerErrorTest, SobolIsNowhereWorseThanIndependent) {
    std::vector<std::pair<std::string, Scene>> scenes{{"everything", scene_of_everything()}};
    for (const std::string name : {"cornell-box", "cornell-glossy", "cornell-glass", "depth-of-field",
                                   "environment", "veach-mis", "mesh", "showcase"})
        scenes.emplace_back(name, load_scene(CANDELA_SCENES "/" + name + ".json"));
    const double level = sidak_level(TEST_ALPHA, scenes.size());
    for (const auto& [name, scene] : scenes) {
        const Image reference = image(scene, SamplerKind::stratified, 1, samples(REFERENCE_SPP));
        const RunningMoments sobol = squared_errors(image(scene, SamplerKind::sobol, 2, SPP), reference);
        const RunningMoments independent =
            squared_errors(image(scene, SamplerKind::independent, 3, SPP), reference);
        const double deviation = std::sqrt(sobol.variance_of_mean() + independent.variance_of_mean());
        const double beyond = std::max(0.0, sobol.mean() - independent.mean());
        EXPECT_GT(0.5 * student_t_p_value(beyond / deviation, double(sobol.count() - 1)), level)
            << name << ": mean squared error " << sobol.mean() << " by Sobol, " << independent.mean()
            << " by independent samples, +- " << deviation;
    }
}

}  // namespace
}  // namespace candela
