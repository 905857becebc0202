// Statistics: tables, closed forms and limits. Reference values without a source were computed with mpmath to
// 30 digits.
#include "base/statistics.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace candela {
namespace {

constexpr double INFINITY_D = std::numeric_limits<double>::infinity();

void expect_relative(double actual, double expected, double tolerance) {
    EXPECT_NEAR(actual / expected, 1.0, tolerance) << actual << " against " << expected;
}

TEST(Statistics, NormalTailHasTheTabulatedValues) {
    expect_relative(normal_p_value(1.0), 0.3173105078629141, 1e-14);
    expect_relative(normal_p_value(-2.0), 0.045500263896358414, 1e-14);
    expect_relative(normal_p_value(3.0), 0.0026997960632601891, 1e-14);
    expect_relative(normal_p_value(6.0), 1.9731752900753963e-9, 1e-13);
    expect_relative(normal_p_value(10.0), 1.5239706048321052e-23, 1e-13);
    EXPECT_EQ(normal_p_value(0.0), 1.0);
    EXPECT_EQ(normal_p_value(-INFINITY_D), 0.0);
}

TEST(Statistics, NormalCriticalValuesAreTheTabulatedOnes) {
    expect_relative(normal_critical_z(0.5), 0.67448975019608174, 1e-14);
    expect_relative(normal_critical_z(0.1), 1.6448536269514727, 1e-14);
    expect_relative(normal_critical_z(0.05), 1.9599639845400542, 1e-14);
    expect_relative(normal_critical_z(0.01), 2.5758293035489008, 1e-14);
    expect_relative(normal_critical_z(1e-9), 6.1094102048693971, 1e-14);
    expect_relative(normal_critical_z(1e-15), 8.0268588825345409, 1e-14);
    EXPECT_NEAR(normal_critical_z(1.0), 0.0, 1e-15);
    EXPECT_EQ(normal_critical_z(0.0), INFINITY_D);
}

TEST(Statistics, NormalCriticalValueInvertsTheTail) {
    for (double p = 0.9; p > 1e-300; p *= 0.01)
        expect_relative(normal_p_value(normal_critical_z(p)), p, 1e-11);
}

TEST(Statistics, SidakLevelRestoresTheLevelOverAllTests) {
    EXPECT_DOUBLE_EQ(sidak_level(0.01, 1), 0.01);
    EXPECT_NEAR(sidak_level(0.05, 3), 0.016952427508441503, 1e-16);
    for (const uint64_t tests : {2u, 100u, 786'432u, 300'000'000u}) {
        const double level = sidak_level(0.01, tests);
        expect_relative(-std::expm1(double(tests) * std::log1p(-level)), 0.01, 1e-13);
    }
    // Bonferroni's level is the limit for small alpha; a formula that cancels would give 0 here.
    expect_relative(sidak_level(1e-12, 1'000'000'000), 1e-21, 1e-11);
    EXPECT_EQ(sidak_level(0.0, 5), 0.0);
}

// Ref: NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.4 (upper critical values, five digits).
TEST(Statistics, ChiSquaredHasTheTabulatedValues) {
    EXPECT_NEAR(chi_squared_p_value(3.841, 1), 0.05, 2e-5);
    EXPECT_NEAR(chi_squared_p_value(18.307, 10), 0.05, 2e-6);
    EXPECT_NEAR(chi_squared_p_value(124.342, 100), 0.05, 2e-6);
    EXPECT_NEAR(chi_squared_p_value(6.635, 1), 0.01, 2e-6);
    EXPECT_NEAR(chi_squared_p_value(23.209, 10), 0.01, 2e-6);
}

TEST(Statistics, ChiSquaredIsAccurateOnBothSidesOfTheMean) {
    expect_relative(chi_squared_p_value(18.307, 10), 0.05000058909139812, 1e-13);
    expect_relative(chi_squared_p_value(5, 3), 0.17179714429673314, 1e-13);
    expect_relative(chi_squared_p_value(300, 100), 7.4121008573228768e-22, 1e-12);
    expect_relative(chi_squared_p_value(10'100, 10'000), 0.23901532524017511, 1e-10);
    expect_relative(chi_squared_p_value(1'002'000, 1'000'000), 0.078718661386129633, 1e-8);
    EXPECT_DOUBLE_EQ(chi_squared_p_value(1, 50), 1.0);
}

TEST(Statistics, ChiSquaredHasItsClosedForms) {
    for (const double x : {1e-3, 0.5, 1.9, 2.1, 10.0, 30.0}) {
        expect_relative(chi_squared_p_value(x, 2), std::exp(-x / 2), 1e-13);
        expect_relative(chi_squared_p_value(x * x, 1), normal_p_value(x), 1e-10);
        expect_relative(chi_squared_p_value(x, 4), std::exp(-x / 2) * (1 + x / 2), 1e-13);
    }
    EXPECT_EQ(chi_squared_p_value(0, 7), 1.0);
    EXPECT_EQ(chi_squared_p_value(INFINITY_D, 7), 0.0);
}

// Ref: NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2 (upper critical values, four digits).
TEST(Statistics, StudentTHasTheTabulatedValues) {
    EXPECT_NEAR(student_t_p_value(12.706, 1), 0.05, 2e-6);
    EXPECT_NEAR(student_t_p_value(2.228, 10), 0.05, 2e-5);
    EXPECT_NEAR(student_t_p_value(2.042, 30), 0.05, 5e-5);
    expect_relative(student_t_p_value(2.228, 10), 0.050011771817111365, 1e-13);
    expect_relative(student_t_p_value(-3.5, 4.7), 0.019129593500276431, 1e-13);
    expect_relative(student_t_p_value(50, 3), 1.7617152041271974e-5, 1e-13);
    expect_relative(student_t_p_value(0.01, 5), 0.9924080180425819, 1e-13);
}

TEST(Statistics, StudentTHasItsClosedFormsAndTheNormalLimit) {
    for (const double t : {1e-3, 0.3, 1.0, 4.0, 200.0}) {
        EXPECT_NEAR(student_t_p_value(t, 1), 1 - 2 / std::numbers::pi * std::atan(t), 1e-13);
        EXPECT_NEAR(student_t_p_value(t, 2), 1 - t / std::sqrt(2 + t * t), 1e-13);
    }
    expect_relative(student_t_p_value(1.96, 1e6), 0.049996067585269791, 1e-9);
    EXPECT_EQ(student_t_p_value(0, 9), 1.0);
    EXPECT_EQ(student_t_p_value(-INFINITY_D, 9), 0.0);
}

TEST(Statistics, IncompleteBetaIsSymmetricAndHasItsClosedForms) {
    for (const double x : {0.01, 0.3, 0.5, 0.99}) {
        EXPECT_NEAR(beta_i(x, 1, 1), x, 1e-15);
        EXPECT_NEAR(beta_i(x, 3, 1), x * x * x, 1e-15);
        EXPECT_NEAR(beta_i(x, 2.5, 7) + beta_i(1 - x, 7, 2.5), 1.0, 1e-14);
    }
    EXPECT_EQ(beta_i(0, 2, 3), 0.0);
    EXPECT_EQ(beta_i(1, 2, 3), 1.0);
}

TEST(Statistics, RunningMomentsOfAFewNumbers) {
    RunningMoments moments;
    EXPECT_EQ(moments.mean(), 0.0);
    EXPECT_EQ(moments.variance(), 0.0);
    for (const double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0})
        moments.add(x);
    EXPECT_EQ(moments.count(), 8u);
    EXPECT_DOUBLE_EQ(moments.mean(), 5.0);
    EXPECT_DOUBLE_EQ(moments.variance(), 32.0 / 7.0);
    EXPECT_DOUBLE_EQ(moments.variance_of_mean(), 4.0 / 7.0);
}

TEST(Statistics, RunningMomentsDoNotCancel) {
    // Sums of squares would lose every digit of the variance here.
    RunningMoments moments;
    for (const double x : {4.0, 7.0, 13.0, 16.0})
        moments.add(1e9 + x);
    EXPECT_DOUBLE_EQ(moments.mean(), 1e9 + 10.0);
    EXPECT_DOUBLE_EQ(moments.variance(), 30.0);
}

}  // namespace
}  // namespace candela
