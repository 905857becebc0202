// The small functions under everything: finiteness, cosine and sine, compensated sums, MIS weights, frames.
#include <cmath>
#include <limits>

#include "gpu/device_fixture.h"
#include "support/reference_random.h"

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

// Kahan's sum is off by 2 * 2^-24 of the exact one, and sum - compensation by less. A plain sum would not
// move at all in the first case and lose a quarter of the addends in the second. (Lavapipe ends all loops of
// an invocation after 65 535 turns.)
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
    std::vector<Item> items{{vec3(0.0f, 1.0f, 0.0f)}, {vec3(1.0f, 0.0f, 0.0f)},  {vec3(INFINITE, 1.0f, 0.0f)},
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
    for (int i = 0; i < 10000; ++i)
        add(random.direction(), random.cube());

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
