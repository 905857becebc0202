// Alias tables represent exactly the distribution from which they were made.
#include "gpu_scene/alias_table.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace candela {
namespace {

// The probability of each index as a shader draws it: column i is kept for fractions below its threshold /
// 2^32.
std::vector<double> drawn(const std::vector<AliasEntry>& table) {
    std::vector<double> probability(table.size());
    for (size_t i = 0; i < table.size(); ++i) {
        const double kept = double(table[i].threshold) * 0x1p-32;
        probability[i] += kept / double(table.size());
        probability[table[i].alias] += (1.0 - kept) / double(table.size());
    }
    return probability;
}

// Each threshold is rounded to 2^-32 of a column, 1 being rounded to 1 - 2^-32. The index of the largest
// weight may be the alias of all columns, which gives its bound; the others need only one column.
void expect_distribution(const std::vector<double>& weights) {
    const std::vector<AliasEntry> table = build_alias_table(weights);
    ASSERT_EQ(table.size(), weights.size());
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<double> probability = drawn(table);
    for (size_t i = 0; i < weights.size(); ++i) {
        const double expected = weights[i] / total;
        ASSERT_LT(table[i].alias, table.size());
        EXPECT_NEAR(probability[i], expected, 0x1p-32) << i;
    }
}

TEST(AliasTable, ReproducesItsWeights) {
    expect_distribution({1, 1, 1, 1});
    expect_distribution({1, 2, 3, 4, 5, 6, 7});
    expect_distribution({0.1, 0.2, 0.3, 0.4});
    std::vector<double> harmonic(1000);
    for (size_t i = 0; i < harmonic.size(); ++i)
        harmonic[i] = 1.0 / double(i + 1);
    expect_distribution(harmonic);
}

TEST(AliasTable, OneEntryIsAlwaysDrawn) {
    const std::vector<AliasEntry> table = build_alias_table(std::vector<double>{1e-30});
    ASSERT_EQ(table.size(), 1u);
    EXPECT_EQ(table[0].alias, 0u);
    EXPECT_EQ(drawn(table)[0], 1.0);
}

TEST(AliasTable, AZeroWeightIsNeverDrawn) {
    for (const std::vector<double>& weights :
         {std::vector<double>{0, 1}, {1, 0}, {0, 0, 5, 0}, {3, 0, 1, 0, 2, 0}, {0, 1, 1, 1, 1, 1, 1}}) {
        expect_distribution(weights);
        const std::vector<double> probability = drawn(build_alias_table(weights));
        for (size_t i = 0; i < weights.size(); ++i) {
            if (weights[i] == 0.0) {
                EXPECT_EQ(probability[i], 0.0) << i;
            }
        }
    }
}

TEST(AliasTable, ExtremeRatiosKeepTheLargeAndTheSmall) {
    expect_distribution({1e-300, 1e300});
    expect_distribution({1e300, 1e-300, 1e300});
    expect_distribution({1e-9, 1.0, 1e9});
    std::vector<double> one_of_many(10000, 1e-12);
    one_of_many[5000] = 1.0;
    expect_distribution(one_of_many);
}

}  // namespace
}  // namespace candela
