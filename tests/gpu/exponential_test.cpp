// Exponential and logarithm against the standard library's in double precision.
#include <bit>
#include <cmath>

#include "gpu/device_fixture.h"
#include "selftest/random.h"

namespace candela {
namespace {

struct Values {
    float log1p, exp, expm1;
};

class ExponentialTest : public DeviceTest {
  protected:
    std::vector<Values> run(const std::vector<float>& x) const {
        std::vector<vec4> items;
        for (const float value : x)
            items.emplace_back(value, 0.0f, 0.0f, 0.0f);
        return map<Values>(kernels::exponential, items);
    }
};

// Negative numbers of every size from -2^-100 to `least`, on a logarithmic scale, `least` included.
std::vector<float> of_every_size(double least) {
    std::vector<float> x;
    const int count = 100000;
    for (int i = 0; i <= count; ++i)
        x.push_back(float(-std::exp2(-100.0 + (std::log2(-least) + 100.0) * i / count)));
    x.back() = float(least);
    return x;
}

// The floats around `x`, 64 on either side.
void add_neighbours(std::vector<float>& out, float x) {
    for (int steps = -64; steps <= 64; ++steps)
        out.push_back(std::bit_cast<float>(std::bit_cast<uint32_t>(x) + uint32_t(steps)));
}

// In units of 2^-24 of the result: s = f / (2 + f) carries a division, 5 by Vulkan's rules (2.5 ulp), and a
// sum, 1; where the mantissa is taken from the rounded 1 + x, below -0.2929, that is off by 1/2 of itself and
// the logarithm by 1/2 / (0.7 * 0.35) = 2 at most, just there; the additions of the series, multiplied by
// less than 0.36 where they add to an exponent, are less than 1 more.
TEST_F(ExponentialTest, TheLogarithmIsGoodToTheLastDigits) {
    std::vector<float> x = of_every_size(-1.0 + 0x1p-24);
    add_neighbours(x, -0.2929f);
    for (const float scale : {0.25f, 0.125f, 0x1p-10f}) {  // 1 + x around scale and scale / sqrt(2).
        add_neighbours(x, scale - 1.0f);
        add_neighbours(x, scale * std::sqrt(0.5f) - 1.0f);
    }
    add_neighbours(x, -0.5f);
    for (int i = 0; i < 100; ++i)
        x.push_back(-1.0f + float(i + 1) * 0x1p-24f);  // 1 - u for the last u of [0, 1).
    const std::vector<Values> values = run(x);
    for (size_t i = 0; i < x.size(); ++i) {
        const double expected = std::log1p(double(x[i]));
        ASSERT_NEAR(values[i].log1p, expected, 8 * 0x1p-24 * -expected) << x[i];
    }
}

TEST_F(ExponentialTest, TheLogarithmIsFiniteAtItsPole) {
    const std::vector<Values> values = run({-1.0f, 0.0f});
    EXPECT_NEAR(values[0].log1p, -88.0, 0.1);
    EXPECT_EQ(values[1].log1p, 0.0f);
}

// exp(x) = 2^k (1 + p): p <= 0.42 has the roundings of its series, 1.5, and of x - k log(2), less than 1 of
// 0.35; the final product and sum add 1. expm1 cancels at worst at k = -1, p = 0.41: 0.3 out of 0.5.
TEST_F(ExponentialTest, ExponentialsAreGoodToTheLastDigits) {
    std::vector<float> x = of_every_size(-87.0);
    for (int k = 0; k < 126; ++k)
        add_neighbours(x,
                       float(-std::log(2.0) * (k + 0.5)));  // Where one power of two gives way to the next.
    const std::vector<Values> values = run(x);
    for (size_t i = 0; i < x.size(); ++i) {
        if (x[i] < -87.0f) continue;
        const double exp = std::exp(double(x[i])), expm1 = std::expm1(double(x[i]));
        ASSERT_NEAR(values[i].exp, exp, 3 * 0x1p-24 * exp) << x[i];
        ASSERT_NEAR(values[i].expm1, expm1, 3 * 0x1p-24 * -expm1) << x[i];
    }
}

TEST_F(ExponentialTest, ExponentialsEndInZeroAndMinusOne) {
    for (const Values& v : run({-87.001f, -88.0f, -1000.0f, -1e30f, -3e38f})) {
        EXPECT_EQ(v.exp, 0.0f);
        EXPECT_EQ(v.expm1, -1.0f);
    }
    EXPECT_EQ(run({0.0f})[0].exp, 1.0f);
    EXPECT_EQ(run({0.0f})[0].expm1, 0.0f);
}

}  // namespace
}  // namespace candela
