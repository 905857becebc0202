// The tree over lights on the device: importance against closed forms, ways down against their probabilities,
// and no light that lights a point without a way to it.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/statistics.h"
#include "gpu/light_fixture.h"
#include "gpu_scene/light_tree_arrays.h"
#include "probe/random.h"

namespace candela {
namespace {

// A scene of nothing but a tree over these lights.
GpuScene scene_of(const std::vector<LightBounds>& lights) {
    GpuScene scene;
    LightTreeArrays arrays = pack_light_trees(build_light_tree(lights));
    scene.arrays[ARRAY_LIGHT_TREE] = std::move(arrays.nodes);
    scene.arrays[ARRAY_LIGHT_TRAILS] = std::move(arrays.trails);
    scene.light_count = scene.light_groups.placed = uint32_t(lights.size());
    return scene;
}

KernelConstants tree_constants() {
    KernelConstants constants;
    constants[CONSTANT_LIGHT_SAMPLER] = LIGHT_SAMPLER_TREE;
    constants[CONSTANT_LIGHTS] = 1u << LIGHT_TRIANGLE;  // No suns and no sky.
    return constants;
}

float log_uniform(Random& random, float least, float most) {
    return least * std::pow(most / least, random.unit());
}

// A light as small as a point, which shines from p along the axis.
LightBounds lamp(vec3 p, vec3 axis, double strength = 1.0) {
    return {.box = {p, p},
            .axis = axis,
            .normals = 0.0f,
            .emission = 0.5f * PI,
            .two_sided = false,
            .strength = strength};
}

// Lights of every kind around the origin, and the power of each over pi; sizes and powers are of very
// different orders of magnitude.
std::vector<std::pair<LightRecord, double>> mixed_lights(size_t count, uint32_t seed) {
    Random random(seed);
    std::vector<std::pair<LightRecord, double>> lights;
    for (size_t i = 0; i < count; ++i) {
        constexpr std::array KINDS{LIGHT_TRIANGLE, LIGHT_TRIANGLE, LIGHT_PARALLELOGRAM, LIGHT_DISK,
                                   LIGHT_SPHERE,   LIGHT_POINT,    LIGHT_SPOT};
        const float size = log_uniform(random, 1e-6f, 1.0f);
        LightRecord l{};
        l.kind = KINDS[i % KINDS.size()];
        l.p = random.cube();
        l.e1 = l.kind == LIGHT_SPOT ? random.direction() : size * random.direction();
        const float width = size * random.unit();
        l.e2 = width * cross(normalize(l.e1), random.direction());
        l.two_sided = random.unit() < 0.3f && l.kind < LIGHT_SPHERE;
        l.radiance = vec3(log_uniform(random, 1e-6f, 1e6f));
        if (l.kind == LIGHT_SPHERE) l.e1 = vec3(size, 0, 0);
        if (l.kind == LIGHT_SPOT) l.e2 = vec3(0.01f + 0.9f * random.unit(), 100.0f, 0);
        lights.emplace_back(l, log_uniform(random, 1e-6f, 1e6f));
    }
    return lights;
}

std::vector<LightBounds> bounds_of(const std::vector<std::pair<LightRecord, double>>& lights) {
    std::vector<LightBounds> bounds;
    for (const auto& [light, power] : lights)
        bounds.push_back(bounds_of(light, power));
    return bounds;
}

// A point on a light, and whether the light shines from there in a direction.
struct Emitted {
    dvec3 p;
    dvec3 n{0};  // 0: all around.
    double least_cosine = 0.0;
    bool two_sided = false;

    bool shines(const dvec3& w) const {
        const double cosine = dot(n, normalize(w));
        return n == dvec3(0) || (two_sided ? std::abs(cosine) : cosine) > least_cosine;
    }
};

Emitted point_on(const LightRecord& l, Random& random) {
    const dvec3 p(l.p), e1(l.e1), e2(l.e2);
    const vec2 u = random.square();
    switch (l.kind) {
        case LIGHT_POINT:
            return {.p = p};
        case LIGHT_SPOT:
            return {.p = p, .n = e1, .least_cosine = 1.0 - double(l.e2.x)};
        case LIGHT_SPHERE: {
            const dvec3 n(random.direction());
            return {.p = p + double(l.e1.x) * n, .n = n};
        }
        default: {
            vec2 b = u;
            if (l.kind == LIGHT_TRIANGLE) b = vec2(u.x * (1.0f - u.y), u.y);
            if (l.kind == LIGHT_DISK) b = u.x * vec2(std::cos(2.0f * PI * u.y), std::sin(2.0f * PI * u.y));
            return {.p = p + double(b.x) * e1 + double(b.y) * e2,
                    .n = normalize(cross(e1, e2)),
                    .two_sided = l.two_sided != 0};
        }
    }
}

class LightTreeTest : public LightTest {
  protected:
    std::vector<LightTreeWay> ways(const GpuScene& scene, const std::vector<LightTreeItem>& items) const {
        const DeviceScene on_device(device(), scene, SceneAccess::texel_buffers);
        return probe<LightTreeWay>(device(), kernels::light_tree, items, tree_constants(), &on_device);
    }
};

// Four lamps in one node, of which each has its part by strength, two cosines and a squared distance. The
// tree adds 0.003 to each cosine, and an axis has 10 bits, 0.002 of a cosine: at cosines of at least 0.3, a
// product of two is right within 4 %, and so are parts of a sum.
TEST_F(LightTreeTest, ImportanceIsThatOfLampsAsSmallAsPoints) {
    Random random(1);
    for (int k = 0; k < 20; ++k) {
        const vec3 p = random.cube(), n = random.direction();
        const bool any_normal = k % 3 == 1, both_sides = k % 3 == 2;
        std::vector<LightBounds> lamps;
        std::vector<double> expected;
        while (lamps.size() < 4) {
            const vec3 at = p + log_uniform(random, 1e-3f, 1e3f) * random.direction(),
                       axis = random.direction();
            const double d = length(dvec3(at) - dvec3(p));
            const dvec3 w = (dvec3(at) - dvec3(p)) / d;
            const double cos_i = any_normal   ? 1.0
                                 : both_sides ? std::abs(dot(w, dvec3(n)))
                                              : dot(w, dvec3(n));
            const double cos_o = -dot(w, dvec3(axis));
            if (cos_i < 0.3 || cos_o < 0.3) continue;
            const double strength = d * d * double(log_uniform(random, 0.1f, 1.0f));
            lamps.push_back(lamp(at, axis, strength));
            expected.push_back(strength * cos_i * cos_o / (d * d));
        }
        std::vector<LightTreeItem> items;
        for (uint32_t i = 0; i < 4; ++i)
            items.push_back({p, i, any_normal ? vec3(0) : n, both_sides});
        const std::vector<LightTreeWay> found = ways(scene_of(lamps), items);
        const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
        for (size_t i = 0; i < 4; ++i)
            EXPECT_NEAR(double(found[i].by_importance), expected[i] / sum, 0.04 * expected[i] / sum + 0x1p-15)
                << k;
    }
}

TEST_F(LightTreeTest, LampsThatCannotLightAPointHaveNoImportance) {
    std::vector<LightBounds> lamps{lamp(vec3(0, 1, 0), vec3(0, -1, 0)),     // Above, turned to the point;
                                   lamp(vec3(0.2f, 1, 0), vec3(0, 1, 0)),   // turned away;
                                   lamp(vec3(0, -1, 0.1f), vec3(0, 1, 0)),  // below the horizon;
                                   lamp(vec3(0.1f, 1, 0), vec3(0.9f, -0.4f, 0))};  // a spot,
    lamps[3].axis = normalize(lamps[3].axis);
    lamps[3].emission = 0.5f;  // outside whose cone the point lies.
    std::vector<LightTreeItem> items;
    for (const uint32_t both_sides : {0u, 1u}) {
        for (uint32_t i = 0; i < 4; ++i)
            items.push_back({vec3(0), i, vec3(0, 1, 0), both_sides});
    }
    const std::vector<LightTreeWay> found = ways(scene_of(lamps), items);
    EXPECT_EQ(found[0].by_importance, 1.0f);
    EXPECT_EQ(found[1].by_importance, 0.0f);
    EXPECT_EQ(found[2].by_importance, 0.0f);
    EXPECT_EQ(found[3].by_importance, 0.0f);
    EXPECT_EQ(found[5].by_importance, 0.0f);
    EXPECT_GT(found[6].by_importance, 0.4f);
    for (const LightTreeWay& way : found)
        EXPECT_NEAR(way.by_strength, 1.0 / 4.0, 0x1p-15);
}

// One around the point, whose centre is below the horizon, beside a small one above: their parts are those of
// strength / radius^2, in any direction, and of strength / distance^2, with 0.3 % more for each of two
// cosines.
TEST_F(LightTreeTest, ALightAroundAPointIsInAllDirections) {
    const vec3 centre(0, -1, 0), half(2.0f / std::sqrt(3.0f));
    std::vector<LightBounds> lights{lamp(vec3(0, 1, 0), vec3(0, -1, 0)), lamp(centre, vec3(0, 1, 0), 8.0)};
    lights[1].box = {centre - half, centre + half};
    lights[1].normals = PI;
    const std::vector<LightTreeWay> found =
        ways(scene_of(lights), {{vec3(0), 0, vec3(0, 1, 0), 0}, {vec3(0), 1, vec3(0, 1, 0), 0}});
    EXPECT_NEAR(found[0].by_importance, 1.0 / 3.0, 0.01);
    EXPECT_NEAR(found[1].by_importance, 2.0 / 3.0, 0.01);
}

// A million random points, normals and points on lights: near and far, on a light and in its plane.
TEST_F(LightTreeTest, EveryLightThatLightsAPointHasAWay) {
    constexpr size_t COUNT = 1'000'000;
    const auto lights = mixed_lights(300, 2);
    const std::vector<LightBounds> bounds = bounds_of(lights);
    double sum = 0.0;
    for (const LightBounds& light : bounds)
        sum += light.strength;
    Random random(3);
    std::vector<LightTreeItem> items(COUNT);
    std::vector<bool> lit(COUNT);
    for (size_t i = 0; i < COUNT; ++i) {
        LightTreeItem& item = items[i];
        item.light = random.bits() % uint32_t(lights.size());
        const Emitted from = point_on(lights[item.light].first, random);
        const Emitted near = point_on(lights[random.bits() % lights.size()].first, random);
        const vec3 offset = log_uniform(random, 1e-7f, 1e6f) * random.direction();
        item.p = random.unit() < 0.5f ? offset : vec3(near.p) + offset;
        if (random.unit() < 0.8f) item.n = random.direction();
        if (random.unit() < 0.1f) item.n = normalize(vec3(from.p - dvec3(item.p)));
        item.both_sides = random.unit() < 0.2f;
        const dvec3 w = from.p - dvec3(item.p);
        const double cos_i = dot(w, dvec3(item.n));
        lit[i] = (item.n == vec3(0) || (item.both_sides ? cos_i != 0.0 : cos_i > 0.0)) && from.shines(-w);
    }
    const std::vector<LightTreeWay> found = ways(scene_of(bounds), items);
    size_t starved = 0, lost = 0, rare = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        lost += found[i].arrives != 1;
        // The least part of a child is 2^-10 of 1 + 4 * 2^-10, rounded to 2^-15; a way has five nodes or so.
        starved += lit[i] && !(found[i].by_importance > 1e-20f);
        rare += double(found[i].by_strength) < 0.5 * bounds[items[i].light].strength / sum;
    }
    EXPECT_EQ(lost, 0u);
    EXPECT_EQ(starved, 0u) << "of " << std::ranges::count(lit, true);
    EXPECT_EQ(rare, 0u);
}

// What the random bits choose, at places of every kind.
TEST_F(LightTreeTest, LightsAreChosenAsOftenAsTheirProbabilitySays) {
    constexpr uint32_t SAMPLES = 30000;
    std::vector<LightBounds> coincident(3000, lamp(vec3(0.25f), vec3(0, 1, 0)));
    std::vector<LightBounds> alone{lamp(vec3(0), vec3(1, 0, 0))};
    const std::vector<std::vector<LightBounds>> sets{bounds_of(mixed_lights(7, 4)),
                                                     bounds_of(mixed_lights(300, 5)), coincident, alone};
    const auto on_light = mixed_lights(300, 5)[1].first;
    const std::vector<std::pair<vec3, vec3>> places{
        {vec3(0.1f, 0.2f, 0.3f), vec3(0, 1, 0)},    // Inside the bounds;
        {on_light.p, vec3(0)},                      // on a light;
        {vec3(0.25f, 0.2f, 0.25f), vec3(0, 1, 0)},  // behind lights;
        {vec3(1e6f, 0, 0), vec3(-1, 0, 0)},         // far away.
        {vec3(3, 0, 0), vec3(1, 0, 0)}};            // Nothing is seen.
    const double level = sidak_level(CHI_SQUARED_ALPHA, sets.size() * places.size());
    Random random(6);
    for (size_t k = 0; k < sets.size(); ++k) {
        const GpuScene scene = scene_of(sets[k]);
        const DeviceScene on_device(device(), scene, SceneAccess::texel_buffers);
        double strength = 0.0;
        for (const LightBounds& light : sets[k])
            strength += light.strength;
        for (const auto& [p, n] : places) {
            SCOPED_TRACE(testing::Message() << "lights " << k << ", x " << p.x);
            std::vector<LightChoiceItem> items;
            for (uint32_t i = 0; i < SAMPLES; ++i)
                items.push_back({.p = p,
                                 .choice = random.bits(),
                                 .n = n,
                                 .light = i % scene.light_count,
                                 .more = random.bits()});
            const auto choices =
                probe<LightChoice>(device(), kernels::light_choice, items, tree_constants(), &on_device);
            std::vector<double> pmf(scene.light_count), counts(scene.light_count);
            for (uint32_t i = 0; i < SAMPLES; ++i)
                pmf[items[i].light] = double(choices[i].pmf_of_light);
            // Wherever the point is, as shaders/light/tree.glsl promises.
            for (size_t i = 0; i < pmf.size(); ++i)
                EXPECT_GE(pmf[i], sets[k][i].strength / strength / 32.0) << i;
            for (const LightChoice& choice : choices) {
                ASSERT_LT(choice.chosen, scene.light_count);
                ASSERT_EQ(double(choice.pmf), pmf[choice.chosen]);
                ++counts[choice.chosen];
            }
            // Parts are whole; products of a dozen floats are not.
            EXPECT_NEAR(std::accumulate(pmf.begin(), pmf.end(), 0.0), 1.0, 12 * 0x1p-24);
            if (pmf.size() > 1) {
                EXPECT_GT(pearson_p_value(counts, pmf), level);
            }
        }
    }
}

}  // namespace
}  // namespace candela
