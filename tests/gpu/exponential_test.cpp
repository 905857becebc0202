// Exponential and logarithm: the last digits, and the ends of their ranges.
#include "gpu/device_fixture.h"
#include "selftest/exponentials.h"

namespace candela {
namespace {

using ExponentialTest = DeviceTest;

TEST_F(ExponentialTest, TheLogarithmIsGoodToTheLastDigits) {
    expect_holds(test_logarithm(device()));
}

TEST_F(ExponentialTest, TheLogarithmIsFiniteAtItsPole) {
    const std::vector<Exponentials> values = run_exponentials(device(), {-1.0f, 0.0f});
    EXPECT_NEAR(values[0].log1p, -88.0, 0.1);
    EXPECT_EQ(values[1].log1p, 0.0f);
}

TEST_F(ExponentialTest, ExponentialsAreGoodToTheLastDigits) {
    expect_holds(test_exponentials(device()));
}

TEST_F(ExponentialTest, ExponentialsEndInZeroAndMinusOne) {
    for (const Exponentials& v : run_exponentials(device(), {-87.001f, -88.0f, -1000.0f, -1e30f, -3e38f})) {
        EXPECT_EQ(v.exp, 0.0f);
        EXPECT_EQ(v.expm1, -1.0f);
    }
    const Exponentials at_zero = run_exponentials(device(), {0.0f})[0];
    EXPECT_EQ(at_zero.exp, 1.0f);
    EXPECT_EQ(at_zero.expm1, 0.0f);
}

}  // namespace
}  // namespace candela
