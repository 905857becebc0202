// Distributions for statistical tests, in double precision: normal, chi-squared and Student's t, the
// correction for many tests, and running mean and variance. Independent of images and of rendering.
#pragma once

#include <cstdint>
#include <span>

namespace candela {

// Two-sided tail of the standard normal distribution: the probability of a deviate at least as far from 0 as
// z. In [0, 1], with a relative error below 10^-12; it underflows beyond |z| = 38.
double normal_p_value(double z);

// The inverse: the z >= 0 whose two-sided tail is `p`, in [0, 1]; infinite for 0.
double normal_critical_z(double p);

// The level at which each of `tests` independent tests must be judged so that, when all hypotheses are true,
// the probability that any is rejected is `alpha`, in [0, 1): 1 - (1 - alpha)^(1/tests), without
// cancellation. Ref: Sidak, "Rectangular Confidence Regions for the Means of Multivariate Normal
// Distributions", JASA 62 (1967).
double sidak_level(double alpha, uint64_t tests);

// Regularised upper incomplete gamma function Q(a, x), for a > 0 and x >= 0; in [0, 1].
// Ref: NIST Digital Library of Mathematical Functions, 8.2.4, 8.7.1 (series), 8.9.2 (continued fraction;
// its even part is used).
double gamma_q(double a, double x);

// Probability that a chi-squared statistic with that many degrees of freedom (> 0) is at least `statistic`,
// which is >= 0.
double chi_squared_p_value(double statistic, double degrees_of_freedom);

// Pearson's test: the probability of counts at least as unlikely as these, if each sample falls into bin i
// with a probability proportional to `expected[i]` (>= 0, not all 0; as many as counts). Bins are pooled,
// smallest first, until each pool expects 5 samples or more; the rest joins the last pool. A sample in a bin
// that expects none gives 0; fewer than two pools, which tell nothing, give 1.
double pearson_p_value(std::span<const double> counts, std::span<const double> expected);

// Regularised incomplete beta function I_x(a, b), for a, b > 0 and x in [0, 1]; in [0, 1].
// Ref: NIST Digital Library of Mathematical Functions, 8.17.4 (symmetry), 8.17.22 (continued fraction).
double beta_i(double x, double a, double b);

// Two-sided tail of Student's t distribution: the probability of a value at least as far from 0 as `t`. The
// degrees of freedom (> 0) need not be whole, as in Welch's test.
double student_t_p_value(double t, double degrees_of_freedom);

// Mean and variance of a stream of numbers, without the cancellation of sums of squares.
// Ref: Welford, "Note on a Method for Calculating Corrected Sums of Squares and Products", Technometrics 4
// (1962).
class RunningMoments {
  public:
    void add(double value) {
        ++count_;
        const double delta = value - mean_;
        mean_ += delta / double(count_);
        squares_ += delta * (value - mean_);
    }
    uint64_t count() const { return count_; }
    // Mean of the values; 0 if there are none.
    double mean() const { return mean_; }
    // Unbiased variance of the values; 0 if there are fewer than two.
    double variance() const { return count_ < 2 ? 0.0 : squares_ / double(count_ - 1); }
    // Variance of mean() as an estimate of the expectation, for independent values; 0 if there are fewer than
    // two.
    double variance_of_mean() const { return count_ < 2 ? 0.0 : variance() / double(count_); }

  private:
    uint64_t count_ = 0;
    double mean_ = 0.0;
    double squares_ = 0.0;  // Sum of squared deviations from the mean.
};

}  // namespace candela
