// Tables that a shader inverts choose each place by the words that the division of 2^32 gives it.
#include "gpu_scene/cdf_table.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "probe/random.h"
#include "unit/gpu_scene/cdf_words.h"

namespace candela {
namespace {

constexpr uint64_t ALL_WORDS = uint64_t(1) << 32;

std::vector<CdfEntry> table_of(const std::vector<uint64_t>& words) {
    std::vector<CdfEntry> table;
    append_cdf_table(table, words);
    return table;
}

// The first place whose words, summed up to it, are more than that word.
size_t place_of(const std::vector<uint64_t>& words, uint64_t word) {
    uint64_t end = 0;
    for (size_t i = 0; i < words.size(); ++i) {
        end += words[i];
        if (word < end) return i;
    }
    return words.size();
}

// What the words in the part of the table that `word` is in may choose, both included.
std::pair<size_t, size_t> range_of(const std::vector<CdfEntry>& table, uint64_t word) {
    const uint32_t range = table[(word * table.size()) >> 32].range;
    const size_t first = range & (CDF_MAX_PLACES - 1), more = range >> CDF_PLACE_BITS;
    return {first, more < CDF_MANY_MORE ? first + more : table.size() - 1};
}

std::vector<double> random_weights(size_t n, uint32_t seed) {
    Random random(seed);
    std::vector<double> weights(n);
    for (double& weight : weights)
        weight = random.unit() < 0.3f ? 0.0 : std::pow(1e6, double(random.unit()));
    weights[n / 2] = 1.0;
    return weights;
}

// Each share is rounded at both of its ends, to half a word.
TEST(CdfTable, WordsAreDividedInProportion) {
    const std::vector<double> weights = random_weights(1000, 1);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<uint64_t> words = divide_words(weights);
    EXPECT_EQ(std::accumulate(words.begin(), words.end(), uint64_t(0)), ALL_WORDS);
    for (size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(double(words[i]), weights[i] / total * 0x1p32, 1.0) << i;
        EXPECT_EQ(words[i] > 0, weights[i] > 0.0) << i;
    }
}

TEST(CdfTable, NothingOfPositiveWeightStarves) {
    for (const std::vector<double>& weights : {std::vector<double>{1.0},
                                               {1e-300, 1e300},
                                               {1e300, 1e-300},
                                               {0.0, 1e-300, 1e300, 1e-300, 0.0},
                                               {1e-12, 1e-12, 1.0, 1e-12, 1e-12, 0.0}}) {
        const std::vector<uint64_t> words = divide_words(weights);
        EXPECT_EQ(std::accumulate(words.begin(), words.end(), uint64_t(0)), ALL_WORDS);
        for (size_t i = 0; i < weights.size(); ++i)
            EXPECT_EQ(words[i] > 0, weights[i] > 0.0) << i << " of " << weights.size();
    }
}

TEST(CdfTable, ATableHasTheWordsThatItWasMadeFrom) {
    for (const size_t n : {size_t(1), size_t(2), size_t(7), size_t(1000)}) {
        const std::vector<uint64_t> words = divide_words(random_weights(n, uint32_t(n)));
        EXPECT_EQ(words_of(table_of(words)), words) << n;
    }
}

// Around every bound of a place and of a part; the last table has more places in a part than its entry can
// say.
TEST(CdfTable, ThePlaceOfAWordIsAmongThoseOfItsPart) {
    std::vector<double> crowded(5001, 1e-9);
    crowded[0] = 1.0;
    for (const std::vector<double>& weights :
         {random_weights(1, 1), random_weights(7, 2), random_weights(300, 3), crowded,
          std::vector<double>{0.0, 0.0, 1.0, 0.0}}) {
        const std::vector<uint64_t> words = divide_words(weights);
        const std::vector<CdfEntry> table = table_of(words);
        std::vector<uint64_t> bounds(words.size());
        std::partial_sum(words.begin(), words.end(), bounds.begin());
        for (uint64_t i = 0; i < words.size(); ++i)
            bounds.push_back(i * ALL_WORDS / words.size());
        for (const uint64_t bound : bounds) {
            for (uint64_t word = bound - std::min<uint64_t>(bound, 1); word < std::min(bound + 2, ALL_WORDS);
                 ++word) {
                const auto [first, last] = range_of(table, word);
                const size_t place = place_of(words, word);
                ASSERT_LE(first, place) << word;
                ASSERT_GE(last, place) << word;
                ASSERT_GT(words[first], 0u) << word;
            }
        }
    }
}

}  // namespace
}  // namespace candela
