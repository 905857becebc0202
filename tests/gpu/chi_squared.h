// Pearson's test: do counts in bins follow their expectations?
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/statistics.h"

namespace candela {

// The probability of counts at least as unlikely as these, if each sample falls into bin i with a probability
// proportional to `expected[i]`. Bins are pooled, smallest first, until each pool expects 5 samples or more;
// a sample in a bin that expects none gives 0.
inline double chi_squared_p_value_of(const std::vector<double>& counts, std::vector<double> expected) {
    const double samples = std::accumulate(counts.begin(), counts.end(), 0.0);
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (double& e : expected)
        e *= samples / total;
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });

    double statistic = 0.0;
    int pools = 0;
    double pool_count = 0.0;
    double pool_expected = 0.0;
    for (const size_t i : order) {
        if (expected[i] == 0.0 && counts[i] > 0.0) return 0.0;
        pool_count += counts[i];
        pool_expected += expected[i];
        if (pool_expected < 5.0) continue;
        statistic += (pool_count - pool_expected) * (pool_count - pool_expected) / pool_expected;
        ++pools;
        pool_count = pool_expected = 0.0;
    }
    // What is left over is the largest bins' too-small rest: only possible if all bins together expect
    // under 5.
    return pools < 2 ? 1.0 : chi_squared_p_value(statistic, pools - 1);
}

// Tests of distributions have fixed seeds, so that one device gives one verdict. On a device that rounds
// otherwise the verdict may change; all of a test's hypotheses together are rejected wrongly with this
// probability.
inline constexpr double CHI_SQUARED_ALPHA = 1e-3;

}  // namespace candela
