// The choice among lights: how often the device chooses each, and the probability that it says.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/statistics.h"
#include "gpu/light_fixture.h"
#include "probe/random.h"

namespace candela {
namespace {

// Parts of a scene that light it.
struct Parts {
    std::vector<float> lamps;  // Powers over pi of the lamps.
    std::vector<float> suns;   // Powers over pi of the suns.
    bool sky = false;
};

// Unit squares, one behind the other in one of the planes x = 0, 1, 2, ..., each a lamp; or one black square.
Scene scene_of(const Parts& parts) {
    Scene scene = scene_of_mesh({});
    scene.shapes.clear();
    const auto add_square = [&](float x, std::optional<Emission> emission) {
        add_shape(scene, parallelogram(vec3(x, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)), 0, emission);
    };
    for (const float power : parts.lamps)
        add_square(float(scene.shapes.size()), Emission{vec3(power), false});
    if (parts.lamps.empty()) add_square(0.0f, std::nullopt);
    const double radius_squared =  // For the sphere around the squares' box.
        0.25 * (2.0 + std::pow(double(scene.shapes.size()) - 1.0, 2));
    for (const float power : parts.suns)
        scene.lights.push_back({"", DirectionalLight{.irradiance = vec3(float(power / radius_squared))}});
    if (parts.sky) scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(1e6f), vec3(3e6f)}};
    return scene;
}

// The probability of each light, in the order of the table. A sky this bright has half of all if there are
// others.
std::vector<double> probabilities(const Parts& parts) {
    std::vector<double> powers(parts.lamps.begin(), parts.lamps.end());
    powers.insert(powers.end(), parts.suns.begin(), parts.suns.end());
    double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    if (parts.sky) powers.push_back(total > 0.0 ? total : 1.0);
    total = std::accumulate(powers.begin(), powers.end(), 0.0);
    for (double& power : powers)
        power /= total;
    return powers;
}

class LightChoiceTest : public LightTest {
  protected:
    std::vector<LightChoice> choose(const GpuScene& scene, const std::vector<LightChoiceItem>& items,
                                    uint32_t sampler = LIGHT_SAMPLER_POWER) const {
        const DeviceScene on_device(device(), scene, SceneAccess::texel_buffers);
        KernelConstants constants;
        constants[CONSTANT_LIGHT_SAMPLER] = sampler;
        constants[CONSTANT_LIGHTS] = scene.lights_present;
        constants[CONSTANT_ONE_LIGHT] = scene.light_count == 1;
        return probe<LightChoice>(device(), kernels::light_choice, items, constants, &on_device);
    }
};

// At points with a normal and without one, near and far.
TEST_F(LightChoiceTest, LightsAreChosenAsOftenAsTheirProbabilitySays) {
    constexpr size_t SAMPLES = 30000;
    const std::vector<Parts> scenes{{.lamps = {1, 2, 4}, .suns = {}, .sky = false},
                                    {.lamps = {5, 0.5f}, .suns = {2, 1}, .sky = true},
                                    {.lamps = {3, 0.1f}, .suns = {40}, .sky = false},
                                    {.lamps = {}, .suns = {1, 7, 2}, .sky = false},
                                    {.lamps = {}, .suns = {1, 3}, .sky = true},
                                    {.lamps = {1, 1, 1, 6}, .suns = {}, .sky = true},
                                    {.lamps = {}, .suns = {}, .sky = true}};
    const std::vector<std::pair<vec3, vec3>> points{{vec3(0.5f, 0.2f, 0.3f), vec3(0)},
                                                    {vec3(1, -2, 0.5f), vec3(0, 0, 1)},
                                                    {vec3(1e5f, 0, 0), vec3(-1, 0, 0)}};
    constexpr std::array SAMPLERS{LIGHT_SAMPLER_UNIFORM, LIGHT_SAMPLER_POWER, LIGHT_SAMPLER_TREE};
    const double level = sidak_level(CHI_SQUARED_ALPHA, SAMPLERS.size() * scenes.size() * points.size());
    Random random(310);
    for (size_t k = 0; k < SAMPLERS.size() * scenes.size(); ++k) {
        const Parts& parts = scenes[k / SAMPLERS.size()];
        const uint32_t sampler = SAMPLERS[k % SAMPLERS.size()];
        const GpuScene gpu = build_gpu_scene(scene_of(parts), SceneFrame{});
        const std::vector<double> expected = probabilities(parts);
        ASSERT_EQ(gpu.light_count, expected.size());
        const auto is_sun = [&](size_t i) {
            return gpu.light_groups.placed <= i && i < gpu.light_groups.placed + gpu.light_groups.suns;
        };
        for (const auto& [p, n] : points) {
            SCOPED_TRACE(testing::Message()
                         << "scene " << k / SAMPLERS.size() << ", sampler " << sampler << ", x " << p.x);
            std::vector<LightChoiceItem> items;
            for (uint32_t i = 0; i < SAMPLES; ++i) {
                items.push_back({.p = p,
                                 .choice = random.bits(),
                                 .n = n,
                                 .light = i % gpu.light_count,
                                 .more = random.bits()});
            }
            const std::vector<LightChoice> choices = choose(gpu, items, sampler);
            std::vector<double> pmf(gpu.light_count), counts(gpu.light_count);
            for (size_t i = 0; i < items.size(); ++i) {
                // No ray hits a sun: only whoever chooses one asks for its probability.
                if (!is_sun(items[i].light)) pmf[items[i].light] = double(choices[i].pmf_of_light);
                if (is_sun(choices[i].chosen)) pmf[choices[i].chosen] = double(choices[i].pmf);
            }
            for (const LightChoice& choice : choices) {
                ASSERT_LT(choice.chosen, gpu.light_count);
                ASSERT_EQ(double(choice.pmf), pmf[choice.chosen]);
                ++counts[choice.chosen];
            }
            // Each is a float, off by half of 2^-24 of it at most, and shares are whole numbers of 2^-31.
            EXPECT_NEAR(std::accumulate(pmf.begin(), pmf.end(), 0.0), 1.0,
                        sampler == LIGHT_SAMPLER_TREE ? 0x1p-22 : 0x1p-24);
            for (size_t i = 0; i < pmf.size() && sampler != LIGHT_SAMPLER_TREE; ++i) {
                EXPECT_NEAR(pmf[i], sampler == LIGHT_SAMPLER_POWER ? expected[i] : 1.0 / double(pmf.size()),
                            0x1p-22)
                    << i;
            }
            if (pmf.size() > 1) {
                EXPECT_GT(pearson_p_value(counts, pmf), level);
            }
        }
    }
}

// A group that has a few of all 2^32 words: it has each of them, and each of its lights has its part, but for
// rounding at the ends.
TEST_F(LightChoiceTest, EveryWordOfARareGroupIsUsed) {
    constexpr uint32_t EACH =
        200;  // Words of each sun: its part of the power, which sky and lamps double, is 100 2^-31.
    const float power = EACH / 2 * 0x1p-28f;
    const Parts parts{.lamps = {1, 1, 1, 1}, .suns = {power, power, power}, .sky = true};
    const GpuScene gpu = build_gpu_scene(scene_of(parts), SceneFrame{});
    ASSERT_EQ(gpu.light_groups.sky_fraction, 1u << 30);
    ASSERT_EQ(gpu.light_groups.sun_fraction, 3 * EACH / 2);
    std::vector<LightChoiceItem> items;
    for (uint32_t i = 0; i < 3 * EACH + 2; ++i)
        items.push_back({.choice = 2 * gpu.light_groups.sky_fraction - 1 + i});
    const std::vector<LightChoice> choices = choose(gpu, items);
    EXPECT_EQ(choices.front().chosen, 7u);  // The sky.
    EXPECT_EQ(choices.back().chosen, 0u);   // A lamp.
    for (const uint32_t sun : {4u, 5u, 6u})
        EXPECT_NEAR(double(std::ranges::count(choices, sun, &LightChoice::chosen)), EACH, 2.0) << sun;
}

}  // namespace
}  // namespace candela
