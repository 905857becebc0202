// Pearson's test and Student's, judged by their own rates: how often they reject the right distribution, and
// a wrong one.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/statistics.h"

namespace candela {
namespace {

// Probability that one of the checks of a rate fails although all is right; seeds are fixed.
constexpr double ALPHA = 1e-3;

// Counts of `samples` that fall into bins with probabilities proportional to `weights`: each bin in turn gets
// its share of the rest.
std::vector<double> draw(const std::vector<double>& weights, uint64_t samples, std::mt19937& random) {
    double rest = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> counts;
    for (const double weight : weights) {
        const double fraction = rest > weight ? weight / rest : 1.0;
        std::binomial_distribution<uint64_t> binomial(samples, fraction);
        const uint64_t count = samples == 0 || weight == 0.0 ? 0 : binomial(random);
        counts.push_back(double(count));
        samples -= count;
        rest -= weight;
    }
    return counts;
}

// Largest distance between the distribution function of the p-values and that of the uniform distribution.
double distance_to_uniform(std::vector<double> p) {
    std::ranges::sort(p);
    const auto n = double(p.size());
    double distance = 0.0;
    for (size_t i = 0; i < p.size(); ++i)
        distance = std::max({distance, p[i] - double(i) / n, double(i + 1) / n - p[i]});
    return distance;
}

// The bound that this distance exceeds with a probability of at most `alpha`.
// Ref: Massart, "The Tight Constant in the Dvoretzky-Kiefer-Wolfowitz Inequality", Annals of Probability 18
// (1990).
double distance_bound(size_t n, double alpha) {
    return std::sqrt(std::log(2.0 / alpha) / (2.0 * double(n)));
}

// Even and odd numbers of bins: all alike; with a few large ones and most so rare that they are pooled; and
// with one that expects nothing.
std::vector<std::vector<double>> distributions() {
    std::vector<std::vector<double>> all;
    for (const size_t bins : {2u, 3u, 7u, 64u, 257u})
        all.emplace_back(bins, 1.0);
    std::vector<double> geometric, ramp;
    for (int i = 0; i < 61; ++i) {
        geometric.push_back(std::pow(0.8, i));
        ramp.push_back(double(i));
    }
    all.push_back(geometric);
    all.push_back(ramp);
    std::vector<double> few_and_many(301, 0.02);
    few_and_many[7] = few_and_many[200] = few_and_many[201] = 10.0;
    all.push_back(few_and_many);
    return all;
}

TEST(Pearson, PValuesOfTheRightDistributionAreUniform) {
    constexpr size_t RUNS = 2000, SAMPLES = 20000;
    // The p-values of counts, which are whole numbers, come in steps. These are largest with 2 bins: twice
    // the probability of the most likely count, sqrt(2 / (pi N)).
    const double step = 2.0 * std::sqrt(2.0 / (M_PI * double(SAMPLES)));
    const std::vector<std::vector<double>> all = distributions();
    const double alpha = sidak_level(ALPHA, all.size());
    std::mt19937 random(1);
    for (size_t k = 0; k < all.size(); ++k) {
        std::vector<double> p;
        for (size_t run = 0; run < RUNS; ++run)
            p.push_back(pearson_p_value(draw(all[k], SAMPLES, random), all[k]));
        EXPECT_LT(distance_to_uniform(p), distance_bound(RUNS, alpha) + step) << "distribution " << k;
    }
}

// How many samples it takes. If half of the cells get a share e too much and the others too little, N samples
// add N e^2 to the statistic, which otherwise is the number of cells c, less 1, with the deviation sqrt(2 c).
// At the level 10^-5, that of 100 cases, 362 are rejected for c = 256, and 121 for c = 64; 3.5 deviations
// beyond that, N e^2 is 240 or 150. So 600 000 samples in 256 cells or 400 000 in 64 find 2 %; and 200 000 in
// 256 find 3.5 %.
TEST(Pearson, RejectsADensityThatIsTwoPercentOff) {
    constexpr size_t RUNS = 1000;
    struct Layout {
        size_t cells;
        uint64_t samples;
        double error;
    };
    std::mt19937 random(2);
    for (const auto& [cells, samples, error] :
         {Layout{256, 600000, 0.02}, Layout{64, 400000, 0.02}, Layout{256, 200000, 0.035}}) {
        for (const bool by_halves : {true, false}) {
            std::vector<double> off;
            for (size_t i = 0; i < cells; ++i)
                off.push_back((by_halves ? i < cells / 2 : i % 2 == 0) ? 1.0 + error : 1.0 - error);
            size_t rejected = 0;
            for (size_t run = 0; run < RUNS; ++run)
                rejected +=
                    pearson_p_value(draw(off, samples, random), std::vector<double>(cells, 1.0)) < 1e-5;
            EXPECT_GE(rejected, RUNS - 5)
                << cells << " cells, " << (by_halves ? "halves" : "every other one");
        }
    }
}

// By hand: with 35 samples, the five bins that expect 1 form one pool, which makes three with 10 and 20.
TEST(Pearson, BinsThatExpectLessThanFiveArePooled) {
    const std::vector<double> expected{1, 10, 1, 1, 20, 1, 1};
    const std::vector<double> counts{0, 13, 4, 0, 14, 0, 4};
    EXPECT_DOUBLE_EQ(pearson_p_value(counts, expected),
                     chi_squared_p_value(3.0 * 3.0 / 5.0 + 3.0 * 3.0 / 10.0 + 6.0 * 6.0 / 20.0, 2));
    // The scale of what is expected does not matter.
    EXPECT_DOUBLE_EQ(pearson_p_value(counts, {{0.5, 5, 0.5, 0.5, 10, 0.5, 0.5}}),
                     pearson_p_value(counts, expected));
    // A bin that expects 5 is a pool of its own; one that expects a little less is not.
    EXPECT_DOUBLE_EQ(pearson_p_value({{6, 4}}, {{5, 5}}), chi_squared_p_value(0.4, 1));
    EXPECT_EQ(pearson_p_value({{6, 3}}, {{4.5, 4.5}}), 1.0);
}

// Eight bins of 2: pools of 6, 6 and 4, of which the last one joins the one before.
TEST(Pearson, AShortRestJoinsTheLastPool) {
    const std::vector<double> counts{6, 4, 1, 1, 1, 1, 1, 1};
    const double p = pearson_p_value(counts, std::vector<double>(8, 2.0));
    EXPECT_DOUBLE_EQ(p, chi_squared_p_value(5.0 * 5.0 / 6.0 + 5.0 * 5.0 / 10.0, 1));
}

TEST(Pearson, ASampleWhereNoneIsExpectedIsImpossible) {
    EXPECT_EQ(pearson_p_value({{1000, 1001, 1}}, {{1, 1, 0}}), 0.0);
    EXPECT_DOUBLE_EQ(pearson_p_value({{1000, 1001, 0}}, {{1, 1, 0}}),
                     pearson_p_value({{1000, 1001}}, {{1, 1}}));
}

TEST(Pearson, OnePoolSaysNothing) {
    EXPECT_EQ(pearson_p_value({{1000}}, {{1}}), 1.0);
    EXPECT_EQ(pearson_p_value({{3, 0, 1}}, {{1, 1, 1}}), 1.0);
    EXPECT_EQ(pearson_p_value({{0, 0, 0}}, {{1, 1, 1}}), 1.0) << "no samples";
}

// t of the mean of `count` numbers with that expectation and deviation, against the expectation 1.
double t_of_sample(size_t count, double expectation, double deviation, std::mt19937& random) {
    std::normal_distribution<double> normal(expectation, deviation);
    RunningMoments moments;
    for (size_t i = 0; i < count; ++i)
        moments.add(normal(random));
    return (moments.mean() - 1.0) / std::sqrt(moments.variance_of_mean());
}

// Down to three numbers, where the tails are far from normal.
TEST(StudentT, PValuesOfTheRightMeanAreUniform) {
    constexpr size_t RUNS = 4000;
    const std::vector<size_t> counts{3, 5, 16, 100};
    std::mt19937 random(3);
    for (const size_t count : counts) {
        std::vector<double> p;
        for (size_t run = 0; run < RUNS; ++run)
            p.push_back(student_t_p_value(t_of_sample(count, 1.0, 0.3, random), double(count - 1)));
        EXPECT_LT(distance_to_uniform(p), distance_bound(RUNS, sidak_level(ALPHA, counts.size()))) << count;
    }
}

// Tests of whole images demand a standard error below 0.2 % and a level of 10^-4, where |t| = 3.9: a mean
// that is 2 % off is 10 errors away.
TEST(StudentT, RejectsAMeanThatIsTwoPercentOff) {
    std::mt19937 random(4);
    for (const double mean : {0.98, 1.02}) {
        for (int run = 0; run < 200; ++run)
            ASSERT_LT(student_t_p_value(t_of_sample(1024, mean, 0.002 * 32.0, random), 1023), 1e-4);
    }
}

}  // namespace
}  // namespace candela
