// The builder of the tree over lights: what its nodes say is true of all lights below, whatever the lights
// are.
#include "gpu_scene/light_tree.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "probe/random.h"

namespace candela {
namespace {

// The direction of an axis' word.
dvec3 axis_of(uint32_t word) {
    const auto component = [&](int i) { return double(int32_t(word << (22 - 10 * i)) >> 22); };
    return normalize(dvec3(component(0), component(1), component(2)));
}

double angle_between(const dvec3& a, const dvec3& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

double angle_of(uint32_t half_sine) {
    return 2.0 * std::asin((half_sine & LIGHT_TREE_SINE) / double(LIGHT_TREE_SINE));
}

// Whether a child of a node holds for a light. The bounds are rounded outwards; the rest is that of this
// comparison.
void expect_around(const LightTreeChild& child, const LightBounds& light) {
    const dvec3 centre(child.centre);
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 p(corner & 1 ? light.box.hi.x : light.box.lo.x,
                     corner & 2 ? light.box.hi.y : light.box.lo.y,
                     corner & 4 ? light.box.hi.z : light.box.lo.z);
        EXPECT_LE(length(dvec3(p) - centre), double(child.radius) * (1.0 + 1e-12));
    }
    const double normals = angle_of(child.cone);
    const double reach = double(light.normals) + angle_between(axis_of(child.axis), dvec3(light.axis));
    EXPECT_LE(std::min(reach, double(PI)), normals + 1e-7);
    EXPECT_LE(double(light.emission), angle_of(child.cone >> LIGHT_TREE_EMISSION_SHIFT) + 1e-7);
    EXPECT_LE(light.two_sided, (child.cone & LIGHT_TREE_BOTH_SIDES) != 0);
}

// Follows every light's trail and checks all that it passes. Returns the most nodes on a way.
uint32_t check(const LightTree& tree, const std::vector<LightBounds>& lights) {
    EXPECT_EQ(tree.trails.size(), lights.size());
    uint32_t deepest = 0;
    for (uint32_t i = 0; i < lights.size() && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE(i);
        uint32_t at = 0, depth = 0;
        for (; depth < LIGHT_TREE_MAX_DEPTH && (at & LIGHT_TREE_LEAF_BIT) == 0; ++depth) {
            const LightTreeChild& child = tree.nodes[at][tree.trails[i] >> 2 * depth & 3u];
            expect_around(child, lights[i]);
            at = child.at;
        }
        EXPECT_EQ(at, i | LIGHT_TREE_LEAF_BIT);
        deepest = std::max(deepest, depth);
    }
    return deepest;
}

// Lights of all sizes and directions, with strengths over twelve orders of magnitude.
std::vector<LightBounds> random_lights(size_t count, uint32_t seed) {
    Random random(seed);
    std::vector<LightBounds> lights(count);
    for (LightBounds& light : lights) {
        const vec3 p = random.cube();
        light.box.extend(p);
        const float size = 0.1f * std::pow(random.unit(), 8.0f);
        light.box.extend(p + size * random.cube());
        light.axis = random.direction();
        const float kind = random.unit();
        light.normals = kind < 0.7f ? 0.0f : kind < 0.8f ? PI : PI * random.unit();
        light.emission = 0.5f * PI * (kind < 0.9f ? 1.0f : random.unit());
        light.two_sided = random.unit() < 0.2f;
        light.strength = std::pow(10.0, 12.0 * double(random.unit()) - 6.0);
    }
    return lights;
}

TEST(LightTree, HoldsForEveryLightBelowANode) {
    for (const size_t count : {1, 2, 3, 4, 5, 16, 17, 3000, 9000})
        check(build_light_tree(random_lights(count, uint32_t(count))), random_lights(count, uint32_t(count)));
}

TEST(LightTree, SumsStrengthsUp) {
    const std::vector<LightBounds> lights = random_lights(5000, 1);
    const LightTree tree = build_light_tree(lights);
    double sum = 0.0;
    for (const LightBounds& light : lights)
        sum += light.strength;
    EXPECT_NEAR(tree.strength, sum, 1e-9 * sum);
    std::vector<double> of_children(tree.nodes.size());
    of_children[0] = 1.0;
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        double total = 0.0;
        for (const LightTreeChild& child : tree.nodes[i]) {
            const auto strength = double(child.strength);
            total += strength;
            if ((child.at & LIGHT_TREE_LEAF_BIT) == 0) {
                of_children[child.at] = strength;
            } else if (strength > 0.0) {
                EXPECT_NEAR(strength, lights[child.at & ~LIGHT_TREE_LEAF_BIT].strength / sum,
                            0x1p-24 * strength);
            }
        }
        EXPECT_NEAR(total, of_children[i], 4 * 0x1p-24 * total) << i;  // Four floats, and one.
    }
}

std::vector<uvec4> words(const LightTree& tree) {
    std::vector<uvec4> result;
    for (const LightTreeNode& node : tree.nodes) {
        for (const LightTreeChild& child : node) {
            const auto packed = pack(child);
            result.insert(result.end(), packed.begin(), packed.end());
        }
    }
    return result;
}

TEST(LightTree, IsTheSameForAnyNumberOfThreads) {
    const std::vector<LightBounds> lights = random_lights(20000, 2);
    const LightTree one = build_light_tree(lights, 1);
    for (const unsigned threads : {2u, 7u}) {
        const LightTree many = build_light_tree(lights, threads);
        EXPECT_EQ(words(many), words(one));
        EXPECT_EQ(many.trails, one.trails);
    }
}

// No strength, distance or direction tells these apart, or each splits off alone.
TEST(LightTree, IsNeverTooDeep) {
    constexpr size_t COUNT = 70000;  // Nine levels at least.
    std::vector<LightBounds> coincident(COUNT), growing(COUNT);
    for (size_t i = 0; i < COUNT; ++i) {
        coincident[i].box.extend(vec3(0.25f));
        coincident[i].strength = 1.0;
        growing[i].box.extend(vec3(std::exp2(-0.0017f * float(i)), 0.0f, 0.0f));
        growing[i].strength = std::exp(-0.0003 * double(i));
    }
    EXPECT_EQ(check(build_light_tree(coincident), coincident), 9u);
    EXPECT_LE(check(build_light_tree(growing), growing), LIGHT_TREE_MAX_DEPTH);
}

// With the 4 bytes of a trail.
TEST(LightTree, HasAtMost96BytesALight) {
    for (const size_t count : {100, 1000, 30000}) {
        const LightTree tree = build_light_tree(random_lights(count, 3));
        EXPECT_LE(tree.nodes.size() * sizeof(LightTreeNode) + 4 * count, 96 * count);
    }
}

TEST(LightTree, IsEmptyWithoutLights) {
    const LightTree tree = build_light_tree(std::span<const LightBounds>());
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_EQ(tree.strength, 0.0);
}

}  // namespace
}  // namespace candela
