// The small functions under everything: finiteness, cosine, sine and angle, compensated sums, MIS weights,
// frames.
#include <cmath>
#include <limits>

#include "gpu/device_fixture.h"
#include "probe/random.h"

namespace candela {
namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

class MathTest : public DeviceTest {
  protected:
    struct Item {
        vec3 v;
        uint32_t additions = 0;
    };
    struct Result {
        uint32_t finite;
        float cos, sin;
        float cos_turn, sin_turn;
        float angle;  // Angle of the point (x, y) [turns].
        float weight;
        float sum, compensation;
    };
    std::vector<Result> run(const std::vector<Item>& items) const {
        return map<Result>(kernels::math, items);
    }
};

TEST_F(MathTest, NotFiniteIsSeenInEveryComponent) {
    const float largest = std::numeric_limits<float>::max();
    const std::vector<float> values{0.0f, -1.0f, largest, -largest, INFINITE, -INFINITE, NOT_A_NUMBER};
    std::vector<Item> items;
    for (const float value : values) {
        for (const int axis : {0, 1, 2}) {
            items.push_back({vec3(1.0f)});
            items.back().v[axis] = value;
        }
    }
    const std::vector<Result> results = run(items);
    for (size_t i = 0; i < items.size(); ++i)
        EXPECT_EQ(results[i].finite, is_finite(items[i].v)) << i;
}

// Taylor's remainder is below 2^-31; three roundings of 2^-24 dominate.
TEST_F(MathTest, CosineAndSineOfAnOctantAreAccurate) {
    std::vector<Item> items;
    for (int i = -100000; i <= 100000; ++i)
        items.push_back({vec3(PI / 4.0f * float(i) / 100000.0f, 1.0f, 0.0f)});
    const std::vector<Result> results = run(items);
    for (size_t i = 0; i < items.size(); ++i) {
        ASSERT_NEAR(results[i].cos, std::cos(double(items[i].v.x)), 0x1p-23);
        ASSERT_NEAR(results[i].sin, std::sin(double(items[i].v.x)), 0x1p-23);
    }
}

// The angle 2 pi (t - quarter), at most pi/4, has the roundings of the constant and of the product, 2^-24 of
// itself each: with those of the series, 2^-22 covers both.
TEST_F(MathTest, CosineAndSineOfATurnAreAccurate) {
    std::vector<Item> items;
    for (int i = 0; i <= 100000; ++i)
        items.push_back({vec3(float(i) / 100000.0f, 1.0f, 0.0f)});
    for (const float t : {0x1p-24f, 0.125f - 0x1p-24f, 0.125f + 0x1p-24f, 0.875f, 1.0f - 0x1p-24f})
        items.push_back({vec3(t, 1.0f, 0.0f)});
    const std::vector<Result> results = run(items);
    for (size_t i = 0; i < items.size(); ++i) {
        ASSERT_NEAR(results[i].cos_turn, std::cos(2.0 * M_PI * double(items[i].v.x)), 0x1p-22);
        ASSERT_NEAR(results[i].sin_turn, std::sin(2.0 * M_PI * double(items[i].v.x)), 0x1p-22);
    }
    for (int quarter = 0; quarter <= 4; ++quarter) {
        const Result r = results[size_t(quarter) * 25000];
        EXPECT_EQ(r.cos_turn, quarter % 2 == 0 ? 1.0f - float(quarter % 4) : 0.0f);
        EXPECT_EQ(r.sin_turn, quarter % 2 == 1 ? 2.0f - float(quarter) : 0.0f);
    }
}

// Points all around, at every distance. In turns: the arc tangent of up to 1/8 has a division of 2.5 ulp,
// 2^-25 in all, and three roundings of its own; the reflections add one of 1/2, 2^-25, and one of 1, 2^-25.
TEST_F(MathTest, AnglesAreAccurateInEveryOctant) {
    std::vector<Item> items;
    for (const float distance : {1e-30f, 1e-3f, 1.0f, 1e30f}) {
        for (int i = 0; i < 20000; ++i) {
            const double angle = 2.0 * M_PI * (i + 0.5) / 20000.0;
            items.push_back({distance * vec3(std::cos(angle), std::sin(angle), 0.0)});
        }
    }
    for (const float tiny : {1e-20f, -1e-20f, 1e-7f, -1e-7f}) {
        for (const float one : {1.0f, -1.0f}) {
            items.push_back({vec3(one, tiny, 0.0f)});
            items.push_back({vec3(tiny, one, 0.0f)});
            items.push_back({vec3(one, one * (1.0f + tiny), 0.0f)});
        }
    }
    const std::vector<Result> results = run(items);
    for (size_t i = 0; i < items.size(); ++i) {
        double expected = std::atan2(double(items[i].v.y), double(items[i].v.x)) / (2.0 * M_PI);
        if (expected < 0.0) expected += 1.0;
        ASSERT_NEAR(results[i].angle, expected, 0x1p-23) << items[i].v.x << ' ' << items[i].v.y;
        ASSERT_GE(results[i].angle, 0.0f);
        ASSERT_LE(results[i].angle, 1.0f);
    }
}

TEST_F(MathTest, AnglesOfTheAxesAreExact) {
    const std::vector<Result> results = run({{vec3(1, 0, 0)},
                                             {vec3(0, 1, 0)},
                                             {vec3(-1, 0, 0)},
                                             {vec3(0, -1, 0)},
                                             {vec3(0, 0, 0)},
                                             {vec3(-0.0f, -0.0f, 0)}});
    const std::vector<float> turns{0.0f, 0.25f, 0.5f, 0.75f, 0.0f, 0.0f};
    for (size_t i = 0; i < turns.size(); ++i)
        EXPECT_EQ(results[i].angle, turns[i]) << i;
}

// Kahan's sum is off by 2 * 2^-24 of the exact one, and sum - compensation by less. A plain sum would not
// change at all in the first case and lose a quarter of the addends in the second. (Lavapipe ends all loops
// of an invocation after 65 535 iterations.)
TEST_F(MathTest, CompensatedSumsKeepSmallAddends) {
    const std::vector<Item> items{{vec3(1.0f, 0x1p-26f, 0.0f), 50000}, {vec3(100.0f, 1e-5f, 0.0f), 50000}};
    const std::vector<Result> results = run(items);
    for (size_t i = 0; i < items.size(); ++i) {
        const double exact = double(items[i].v.x) + double(items[i].additions) * double(items[i].v.y);
        EXPECT_NEAR(double(results[i].sum) - double(results[i].compensation), exact, exact * 0x1p-23);
    }
}

TEST_F(MathTest, ThePowerHeuristicIsAPartitionOfOne) {
    Random random(3);
    const float largest = std::numeric_limits<float>::max();
    std::vector<Item> items{{vec3(0.0f, 1.0f, 0.0f)}, {vec3(1.0f, 0.0f, 0.0f)},  {vec3(largest, 1.0f, 0.0f)},
                            {vec3(3.0f, 4.0f, 0.0f)}, {vec3(1e30f, 1.0f, 0.0f)}, {vec3(1e-30f, 1.0f, 0.0f)}};
    for (int i = 0; i < 1000; ++i) {
        const float exponent = 20.0f * random.unit() - 10.0f;
        items.push_back({vec3(std::exp2(exponent), 1.0f, 0.0f)});
    }
    const std::vector<Result> one = run(items);
    for (Item& item : items)
        std::swap(item.v.x, item.v.y);
    const std::vector<Result> other = run(items);
    EXPECT_EQ(one[0].weight, 0.0f);
    EXPECT_EQ(one[1].weight, 1.0f);
    EXPECT_EQ(one[2].weight, 1.0f);
    EXPECT_NEAR(one[3].weight, 9.0 / 25.0, 0x1p-22);
    // Two divisions of 2.5 ulp each on either side.
    for (size_t i = 3; i < items.size(); ++i)
        EXPECT_NEAR(one[i].weight + other[i].weight, 1.0, 0x1p-20) << i;
}

// z: the axes, the neighbourhood of -z where naive constructions fail, and random ones. Each entry of the
// frame is a few products of numbers up to 1 and one division of 2.5 ulp; near -z the division by s + z.z
// cancels nothing, since s has the sign of z.z.
TEST_F(MathTest, FramesAreOrthonormal) {
    struct FrameItem {
        vec3 z;
        float unused0;
        vec3 v;
        float unused1;
    };
    struct FrameResult {
        vec3 x, y, z, local, world;
    };
    std::vector<FrameItem> items;
    const auto add = [&](vec3 z, vec3 v) { items.push_back({z, 0.0f, v, 0.0f}); };
    for (const float sign : {-1.0f, 1.0f}) {
        for (const int axis : {0, 1, 2}) {
            vec3 z(0.0f);
            z[axis] = sign;
            add(z, vec3(0.3f, -0.5f, 0.7f));
        }
        for (const float tilt : {1e-7f, 1e-6f, 1e-5f, 1e-4f, 1e-3f, 1e-2f}) {
            add(normalize(vec3(tilt, -tilt, sign)), vec3(1, 2, 3));
            add(normalize(vec3(1, 1, sign * tilt)), vec3(1, 2, 3));
        }
        add(vec3(1, 0, sign * 0.0f), vec3(1, 2, 3));
    }
    Random random(4);
    for (int i = 0; i < 10000; ++i) {
        const vec3 z = random.direction();
        add(z, random.cube());
    }

    const std::vector<FrameResult> results = map<FrameResult>(kernels::frame, items);
    for (size_t i = 0; i < items.size(); ++i) {
        SCOPED_TRACE(i);
        const glm::dvec3 x(results[i].x), y(results[i].y), z(results[i].z);
        ASSERT_EQ(results[i].z, items[i].z);
        ASSERT_NEAR(dot(x, x), 1.0, 0x1p-20);
        ASSERT_NEAR(dot(y, y), 1.0, 0x1p-20);
        ASSERT_NEAR(dot(x, y), 0.0, 0x1p-20);
        ASSERT_NEAR(dot(x, z), 0.0, 0x1p-20);
        ASSERT_NEAR(dot(y, z), 0.0, 0x1p-20);
        ASSERT_LE(length(cross(x, y) - z), 0x1p-20);  // Right-handed.
        const double size = length(items[i].v);
        ASSERT_NEAR(results[i].local.z, dot(glm::dvec3(items[i].v), z), size * 0x1p-22);
        ASSERT_LE(length(glm::dvec3(results[i].world) - glm::dvec3(items[i].v)), size * 0x1p-19);
    }
}

}  // namespace
}  // namespace candela
