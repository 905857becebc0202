// Lamps on the device: every light of every lamp is chosen as often as its probability says, and a ray that
// hits a lamp finds the density and the radiance of the samples of it.
#include <cmath>
#include <map>
#include <numeric>

#include <glm/gtc/matrix_transform.hpp>

#include "base/statistics.h"
#include "gpu/light_fixture.h"
#include "probe/random.h"

namespace candela {
namespace {

constexpr std::array LIGHT_SAMPLERS{LIGHT_SAMPLER_UNIFORM, LIGHT_SAMPLER_POWER, LIGHT_SAMPLER_TREE};

// Turned, scaled, and mirrored or not.
Transform similarity(Random& random, bool mirrored, dvec3 place, double size) {
    Transform transform;
    const dvec3 scale = size * dvec3(mirrored ? -1.0 : 1.0, 1.0, 1.0);
    transform.append(glm::scale(glm::dmat4(1.0), scale));
    const double angle = 6.0 * double(random.unit());
    transform.append(glm::rotate(glm::dmat4(1.0), angle, dvec3(random.direction())));
    transform.append(glm::translate(glm::dmat4(1.0), place));
    return transform;
}

// Five lamps of a bent strip with triangles of very different size, beside a square, and with `more`, beside
// a point, a sun and a sky. Two of the lamps are brighter and emit from both sides.
Scene scene_of_lamps(bool more) {
    Random random(7);
    Scene scene = scene_with_camera(dvec3(0, 0, 9), dvec3(0), 1.0f);
    const uint32_t grey = add_diffuse(scene, vec3(0.5f));
    TriangleMesh strip;
    for (int i = 0; i < 7; ++i) {
        const float x = std::pow(1.5f, float(i)) - 4.0f;
        add_triangle(strip, vec3(x, 0, 0.1f * float(i * i)), vec3(1.5f * x + 2.0f, 0, 0.5f),
                     vec3(x, float(i % 3 + 1), 0));
    }
    scene.meshes.push_back(strip);
    for (int i = 0; i < 5; ++i) {
        const dvec3 place = 20.0 * dvec3(random.cube());
        const Transform transform = similarity(random, i % 2 == 1, place, std::pow(3.0, i - 2));
        const bool bright = i > 2;
        scene.shapes.push_back({.geometry = MeshInstance{0, transform},
                                .material = grey,
                                .emission = Emission{bright ? vec3(5) : vec3(1, 2, 3), bright}});
    }
    add_shape(scene, parallelogram(vec3(-30, -25, 0), vec3(50, 0, 0), vec3(0, 0, 9)), grey,
              Emission{vec3(1), false});
    if (!more) return scene;
    scene.lights.push_back({"", PointLight{.position = {3, 1, 2}, .intensity = vec3(500)}});
    scene.lights.push_back({"", DirectionalLight{.direction = {0, -1, 0}, .irradiance = vec3(1)}});
    scene.environment = Environment{.size = {2, 1}, .radiance = {vec3(1), vec3(3)}};
    return scene;
}

GpuScene instanced(const Scene& scene) {
    return build_gpu_scene(scene, choose_frame(scene), {.min_uses = 1, .min_triangles = 1});
}

KernelConstants constants_of(const GpuScene& scene, uint32_t sampler) {
    KernelConstants constants;
    constants[CONSTANT_LIGHT_SAMPLER] = sampler;
    constants[CONSTANT_LIGHTS] = scene.lights_present;
    constants[CONSTANT_INSTANCED] = true;
    return constants;
}

// A light's place in the table, and that of its lamp.
using Place = std::pair<uint32_t, uint32_t>;

// All lights that may be chosen but suns.
std::vector<Place> places_of(const GpuScene& scene) {
    std::vector<Place> places;
    const LightGroups& groups = scene.light_groups;
    for (uint32_t i = 0; i < groups.placed; ++i) {
        const uvec4* record = &scene.arrays[ARRAY_LIGHTS][size_t{i} * LIGHT_WORDS];
        if (record[0].w != LIGHT_LAMP) {
            places.emplace_back(i, NO_LIGHT);
            continue;
        }
        for (uint32_t k = 0; k < record[1].x; ++k)
            places.emplace_back(record[0].z + k, i);
    }
    if (groups.sky_fraction > 0) places.emplace_back(groups.placed + groups.suns, NO_LIGHT);
    return places;
}

class LampTest : public LightTest {};

TEST_F(LampTest, LightsAreChosenAsOftenAsTheirProbabilitySays) {
    constexpr uint32_t SAMPLES = 30000;
    Random random(11);
    for (const bool more : {false, true}) {
        const GpuScene scene = instanced(scene_of_lamps(more));
        ASSERT_EQ(scene.instances.size(), 5u);
        const DeviceScene on_device(device(), scene, SceneAccess::texel_buffers);
        const std::vector<Place> places = places_of(scene);
        ASSERT_EQ(places.size(), 5u * 7u + 1u + (more ? 2u : 0u));
        for (const uint32_t sampler : LIGHT_SAMPLERS) {
            for (const auto& [p, n] : {std::pair(vec3(0.1f, 0.05f, 0), vec3(0)),
                                       {vec3(0, -0.3f, 0), vec3(0, 1, 0)},
                                       {vec3(9, 1, 2), vec3(-1, 0, 0)}}) {
                SCOPED_TRACE(testing::Message() << more << ", sampler " << sampler << ", x " << p.x);
                std::vector<LightChoiceItem> items;
                for (uint32_t i = 0; i < SAMPLES; ++i) {
                    const auto& [light, lamp] = places[i % places.size()];
                    items.push_back({.p = p,
                                     .choice = random.bits(),
                                     .n = n,
                                     .light = light,
                                     .more = random.bits(),
                                     .lamp = lamp});
                }
                const auto choices = probe<LightChoice>(device(), kernels::light_choice, items,
                                                        constants_of(scene, sampler), &on_device);
                std::map<Place, double> pmf, counts;
                for (size_t i = 0; i < places.size(); ++i)
                    pmf[places[i]] = double(choices[i].pmf_of_light);
                for (const LightChoice& choice : choices) {
                    const Place place(choice.chosen, choice.lamp);
                    if (choice.chosen == scene.light_groups.placed && more)
                        pmf[place] = double(choice.pmf);  // The sun.
                    ASSERT_TRUE(pmf.contains(place)) << place.first << ' ' << place.second;
                    ASSERT_EQ(double(choice.pmf), pmf[place]);
                    ++counts[place];
                }
                std::vector<double> expected, found;
                for (const auto& [place, probability] : pmf) {
                    expected.push_back(probability);
                    found.push_back(counts[place]);
                }
                // Products of a few dozen floats.
                EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1.0, 24 * 0x1p-24);
                EXPECT_GT(pearson_p_value(found, expected), sidak_level(CHI_SQUARED_ALPHA, 18));
            }
        }
    }
}

// By power, the lamps' lights have the probabilities that they would have if they were baked.
TEST_F(LampTest, PowersAreThoseOfBakedLights) {
    const Scene scene = scene_of_lamps(false);
    const GpuScene with = instanced(scene);
    const GpuScene baked =
        build_gpu_scene(scene, choose_frame(scene), {.min_uses = ~0u, .min_triangles = ~0u});
    const auto probability = [&](const GpuScene& gpu, Place place) {
        const auto pmf = [&](uint32_t i) {
            return double(std::bit_cast<float>(gpu.arrays[ARRAY_LIGHTS][size_t{i} * LIGHT_WORDS + 2].w));
        };
        return pmf(place.first) * (place.second == NO_LIGHT ? 1.0 : pmf(place.second));
    };
    const auto sorted = [&](const GpuScene& gpu) {
        std::vector<double> all;
        for (const Place& place : places_of(gpu))
            all.push_back(probability(gpu, place));
        std::ranges::sort(all);
        return all;
    };
    const std::vector<double> a = sorted(with), b = sorted(baked);
    ASSERT_EQ(a.size(), b.size());
    // Floats of coordinates have errors of 2^-24 of the scene, whose smallest triangles have a thousandth of
    // its size.
    for (size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(a[i], b[i], 1e-3 * b[i]) << i;
}

TEST_F(LampTest, HitsHaveTheDensityAndRadianceOfSamples) {
    const GpuScene scene = instanced(scene_of_lamps(false));
    const DeviceScene on_device(device(), scene, SceneAccess::texel_buffers);
    for (const uint32_t sampler : LIGHT_SAMPLERS) {
        SCOPED_TRACE(sampler);
        const auto samples = probe<LightSample>(device(), kernels::light_sample,
                                                random_light_items(vec3(0.02f, -0.05f, 0.01f), 20000, 5),
                                                constants_of(scene, sampler), &on_device);
        size_t seen = 0, same = 0, light_met = 0;
        for (const LightSample& s : samples) {
            if (s.occluded != 0 || s.pdf == 0.0f) continue;
            ++seen;
            if (s.light_met == NO_LIGHT) continue;
            ++light_met;
            // At the edge of another lamp, the ray in the direction wi may meet that instead.
            same += std::abs(s.pdf_met - s.pdf) <= 1e-3f * s.pdf && s.Li_met == s.Li;
        }
        EXPECT_GT(seen, samples.size() / 4);
        EXPECT_GE(light_met, seen - seen / 1000);
        EXPECT_GE(same, seen - seen / 100);
    }
}

}  // namespace
}  // namespace candela
