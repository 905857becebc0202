// Alias tables as the device samples them: choices among very many and very unequal lights, and texels.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/statistics.h"
#include "gpu/light_fixture.h"
#include "probe/random.h"
#include "selftest/skies.h"

namespace candela {
namespace {

// Weights of every size, in random order; every ninth is zero.
std::vector<double> weights(size_t count, double smallest, uint32_t seed) {
    Random random(seed);
    std::vector<double> weights;
    for (size_t i = 0; i < count; ++i)
        weights.push_back(i % 9 == 4 ? 0.0 : std::pow(smallest, double(random.unit())));
    return weights;
}

class AliasTest : public LightTest {
  protected:
    static constexpr size_t SAMPLES = 100000;

    // How often each light or texel was chosen; its red, a whole number above 0, tells which one it is.
    static std::vector<double> count_by_red(const std::vector<LightSample>& samples, size_t count) {
        std::vector<double> counts(count);
        for (const LightSample& s : samples) {
            const auto i = size_t(s.Li.x) - 1;
            EXPECT_LT(i, count) << "a light without power";
            if (i < count) ++counts[i];
        }
        return counts;
    }
};

// The power of a light is its area times its luminance. Most of a thousand lights are chosen seldom, and
// judged together.
TEST_F(AliasTest, LightsOfVeryUnequalPowerAreChosenByIt) {
    const std::vector<size_t> tables{1, 2, 37, 1000};
    const double level = sidak_level(CHI_SQUARED_ALPHA, tables.size());
    for (const size_t count : tables) {
        SCOPED_TRACE(count);
        Scene scene = scene_of_mesh({});
        scene.shapes.clear();
        std::vector<double> powers = weights(count, 1e-6, uint32_t(230 + count));
        for (size_t i = 0; i < count; ++i) {
            const vec3 radiance = powers[i] > 0.0 ? vec3(float(i + 1), 1.0f, 1.0f) : vec3(0.0f);
            const double luminance = 0.2126 * radiance.x + 0.7152 + 0.0722;
            // One behind the other, each as wide as its power requires.
            const auto width = powers[i] > 0.0 ? float(powers[i] / luminance) : 1.0f;
            powers[i] = powers[i] > 0.0 ? double(width) * luminance : 0.0;
            add_shape(scene, parallelogram(vec3(0, 0, -float(i)), vec3(width, 0, 0), vec3(0, 1, 0)), 0,
                      Emission{radiance, true});
        }
        const std::vector<LightSample> samples =
            sample(build_gpu_scene(scene, SceneFrame{}), random_light_items(vec3(0, 0, 5), SAMPLES, 231));
        EXPECT_GT(pearson_p_value(count_by_red(samples, count), powers), level);
    }
}

// The sky's table has as many entries as texels, here in one row, of equal solid angles. What is not above
// the mean is not chosen.
TEST_F(AliasTest, TexelsOfVeryUnequalLuminanceAreChosenByIt) {
    const std::vector<uint32_t> tables{2, 61, 4096};
    const double level = sidak_level(CHI_SQUARED_ALPHA, tables.size());
    for (const uint32_t count : tables) {
        SCOPED_TRACE(count);
        Environment sky{.size = {count, 1}, .radiance = {}};
        std::vector<double> luminances = weights(count, 1e-6, 240 + count);
        for (uint32_t i = 0; i < count; ++i) {
            // Green carries the weight.
            const auto red = double(i + 1), green = luminances[i] * 1e7 * count;
            sky.radiance.push_back(luminances[i] > 0.0 ? vec3(red, green, 0.0) : vec3(0.0f));
            luminances[i] = luminances[i] > 0.0 ? 0.2126 * red + 0.7152 * double(sky.radiance[i].y) : 0.0;
        }
        const double mean = std::accumulate(luminances.begin(), luminances.end(), 0.0) / count;
        for (double& luminance : luminances)
            luminance = std::max(luminance - mean, 0.0);
        const std::vector<LightSample> samples = sample(build_gpu_scene(scene_under(sky), SceneFrame{}),
                                                        random_light_items(vec3(0), SAMPLES, 241));
        EXPECT_GT(pearson_p_value(count_by_red(samples, count), luminances), level);
    }
}

}  // namespace
}  // namespace candela
