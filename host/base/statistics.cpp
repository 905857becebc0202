// Special functions for p-values: series where they converge fast, continued fractions elsewhere.
#include "base/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace candela {
namespace {

// Relative change at which series and continued fractions stop; a little above the rounding error of one
// step.
constexpr double CONVERGED = 1e-15;
// A bound against endless loops: about 10 sqrt(a) steps suffice, so only parameters beyond 10^10 would need
// more.
constexpr int MAX_STEPS = 1'000'000;

// A continued fraction b0 + a1 / (b1 + a2 / (b2 + ...)), evaluated from the front.
// Ref: Thompson, Barnett, "Coulomb and Bessel Functions of Complex Arguments and Order", J. Comput. Phys. 64
// (1986).
class ContinuedFraction {
  public:
    explicit ContinuedFraction(double b0) : value_(not_zero(b0)), c_(value_) {}

    // Adds the next partial numerator and denominator; false once the value no longer changes.
    bool step(double a, double b) {
        d_ = 1.0 / not_zero(b + a * d_);
        c_ = not_zero(b + a / c_);
        value_ *= c_ * d_;
        return std::abs(c_ * d_ - 1.0) > CONVERGED;
    }
    double value() const { return value_; }

  private:
    static double not_zero(double x) { return x == 0.0 ? std::numeric_limits<double>::min() : x; }

    double value_;
    double c_;
    double d_ = 0.0;
};

// Lower function P(a, x) by its power series; fast for x < a + 1.
double gamma_p_series(double a, double x) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < MAX_STEPS && term > sum * CONVERGED; ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

// Upper function Q(a, x) by its continued fraction; fast for x > a + 1.
double gamma_q_fraction(double a, double x) {
    ContinuedFraction fraction(x + 1.0 - a);
    for (int n = 1; n < MAX_STEPS && fraction.step(n * (a - n), x + 2.0 * n + 1.0 - a); ++n) {
    }
    return std::exp(a * std::log(x) - x - std::lgamma(a)) / fraction.value();
}

// I_x(a, b) by its continued fraction; fast for x < (a + 1) / (a + b + 2).
double beta_i_fraction(double x, double a, double b) {
    ContinuedFraction fraction(1.0);
    for (int m = 0; m < MAX_STEPS; ++m) {
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        const double even = (m + 1.0) * (b - m - 1.0) * x / ((a + 2.0 * m + 1.0) * (a + 2.0 * m + 2.0));
        fraction.step(odd, 1.0);
        if (!fraction.step(even, 1.0)) break;
    }
    const double log_beta = std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
    return std::exp(a * std::log(x) + b * std::log1p(-x) - log_beta) / (a * fraction.value());
}

}  // namespace

double normal_p_value(double z) {
    return std::erfc(std::abs(z) / std::numbers::sqrt2);
}

double normal_critical_z(double p) {
    assert(p >= 0.0 && p <= 1.0);
    if (p == 0.0) return std::numeric_limits<double>::infinity();
    // The tail falls steadily from 1 at 0 to less than the smallest double at 39. Each halving gains one bit.
    double low = 0.0;
    double high = 39.0;
    for (int i = 0; i < 64; ++i) {
        const double middle = 0.5 * (low + high);
        (normal_p_value(middle) > p ? low : high) = middle;
    }
    return high;
}

double sidak_level(double alpha, uint64_t tests) {
    assert(alpha >= 0.0 && alpha < 1.0 && tests > 0);
    return -std::expm1(std::log1p(-alpha) / double(tests));
}

double gamma_q(double a, double x) {
    assert(a > 0.0 && x >= 0.0);
    if (x == 0.0) return 1.0;
    if (std::isinf(x)) return 0.0;
    return x < a + 1.0 ? 1.0 - gamma_p_series(a, x) : gamma_q_fraction(a, x);
}

double chi_squared_p_value(double statistic, double degrees_of_freedom) {
    return gamma_q(0.5 * degrees_of_freedom, 0.5 * statistic);
}

double pearson_p_value(std::span<const double> counts, std::span<const double> expected) {
    constexpr double MIN_EXPECTED = 5.0;  // Least expectation of a pool, so that its count is nearly
                                          // normal.
    assert(counts.size() == expected.size());
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    assert(total > 0.0);
    const double scale = std::accumulate(counts.begin(), counts.end(), 0.0) / total;
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::sort(order, {}, [&](size_t i) { return expected[i]; });

    struct Pool {
        double count = 0.0;
        double expected = 0.0;
    };
    std::vector<Pool> pools(1);
    for (const size_t i : order) {
        if (expected[i] == 0.0 && counts[i] > 0.0) return 0.0;
        if (pools.back().expected >= MIN_EXPECTED) pools.emplace_back();
        pools.back().count += counts[i];
        pools.back().expected += expected[i] * scale;
    }
    if (pools.size() > 1 && pools.back().expected < MIN_EXPECTED) {
        const Pool rest = pools.back();
        pools.pop_back();
        pools.back().count += rest.count;
        pools.back().expected += rest.expected;
    }
    if (pools.size() < 2) return 1.0;
    double statistic = 0.0;
    for (const Pool& pool : pools)
        statistic += (pool.count - pool.expected) * (pool.count - pool.expected) / pool.expected;
    return chi_squared_p_value(statistic, double(pools.size() - 1));
}

double beta_i(double x, double a, double b) {
    assert(x >= 0.0 && x <= 1.0 && a > 0.0 && b > 0.0);
    if (x == 0.0 || x == 1.0) return x;
    const bool direct = x < (a + 1.0) / (a + b + 2.0);
    return direct ? beta_i_fraction(x, a, b) : 1.0 - beta_i_fraction(1.0 - x, b, a);
}

double student_t_p_value(double t, double degrees_of_freedom) {
    assert(degrees_of_freedom > 0.0);
    if (std::isinf(t)) return 0.0;
    return beta_i(degrees_of_freedom / (degrees_of_freedom + t * t), 0.5 * degrees_of_freedom, 0.5);
}

}  // namespace candela
