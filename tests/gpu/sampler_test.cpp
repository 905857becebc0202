// The samplers against a reference on the CPU, bit for bit, and the stratification that they promise.
#include <set>
#include <span>

#include "gpu/sampler_fixture.h"
#include "probe/random.h"
#include "selftest/samplers.h"

namespace candela {
namespace {

// A few (pixel, seed, pair), each with points of its own.
const std::vector<SampleOfPair> FEW_SETS{{0, 0, 0, 0}, {0x00050007, 0, 1, 2}, {0x04000300, 0, 99, 17}};

TEST_F(SamplerTest, IntegerFunctionsMatchTheReference) {
    expect_holds(test_integer_functions(device()));
}

TEST_F(SamplerTest, WordsMatchTheReference) {
    for (const uint32_t sampler : {SAMPLER_INDEPENDENT, SAMPLER_STRATIFIED, SAMPLER_SOBOL})
        expect_holds(test_sampler(device(), sampler));
}

// A (0, 2)-net: every way to cut the square into 2^a x 2^b equal boxes has one of the 2^(a+b) points in each
// box.
bool is_net(std::span<const uvec2> points, uint32_t log2_count) {
    std::vector<bool> taken(points.size());
    for (uint32_t a = 0; a <= log2_count; ++a) {
        const uint32_t b = log2_count - a;
        taken.assign(points.size(), false);
        for (const uvec2 p : points) {
            const uint64_t box = (uint64_t{p.x} >> (32 - a)) << b | uint64_t{p.y} >> (32 - b);
            if (taken[box]) return false;
            taken[box] = true;
        }
    }
    return true;
}

TEST_F(SamplerTest, EveryAlignedRunOfSobolPointsIsANet) {
    for (const SampleOfPair& set : FEW_SETS) {
        const std::vector<uvec2> points = first_points(SAMPLER_SOBOL, set, 4096);
        for (uint32_t k = 0; k <= 12; ++k) {
            for (size_t first = 0; first < points.size(); first += size_t{1} << k)
                ASSERT_TRUE(is_net(std::span(points).subspan(first, size_t{1} << k), k)) << first << ' ' << k;
        }
    }
}

// The pairs of the first 16 bounces, and the last one that a path may use; in many pixels.
TEST_F(SamplerTest, TheFirstSobolPointsOfEveryPairAreANet) {
    constexpr uint32_t LOG2_POINTS = 10, POINTS = 1 << LOG2_POINTS;
    std::vector<uint32_t> all_pairs{PAIR_FIRST_BOUNCE + PAIRS_PER_BOUNCE * DEPTH_SAFETY_LIMIT - 1};
    for (uint32_t pair = 0; pair < PAIR_FIRST_BOUNCE + 16 * PAIRS_PER_BOUNCE; ++pair)
        all_pairs.push_back(pair);
    Random random(3);
    for (const uint32_t pair : all_pairs) {
        std::vector<SampleOfPair> samples;
        for (int set = 0; set < 16; ++set) {
            const uint32_t pixel = random.bits(), seed = random.bits();
            for (uint32_t n = 0; n < POINTS; ++n)
                samples.push_back({pixel, n, seed, pair});
        }
        const std::vector<uvec2> points = pairs(SAMPLER_SOBOL, samples);
        for (size_t first = 0; first < points.size(); first += POINTS) {
            for (uint32_t k = 0; k <= LOG2_POINTS; ++k) {
                ASSERT_TRUE(is_net(std::span(points).subspan(first, size_t{1} << k), k))
                    << "2^" << k << " points of pixel " << samples[first].pixel << ", seed "
                    << samples[first].seed << ", pair " << pair;
            }
        }
    }
}

// The choice goes with the point: every way to cut the cube into 2^(k-1) equal boxes, by halves along each
// axis, has 2 of 2^k points in each box.
TEST_F(SamplerTest, TheThirdSobolWordIsSpreadOverThePointsOfThePair) {
    for (const SampleOfPair& set : FEW_SETS) {
        const std::vector<uvec3> points = triples(SAMPLER_SOBOL, first_samples(set, 1024));
        for (uint32_t k = 1; k <= 10; ++k) {
            for (size_t first = 0; first < points.size(); first += size_t{1} << k) {
                for (uint32_t a = 0; a < k; ++a) {
                    for (uint32_t b = 0; a + b < k; ++b) {
                        std::vector<int> counts(size_t{1} << (k - 1));
                        for (const uvec3 p : std::span(points).subspan(first, size_t{1} << k)) {
                            const uint32_t c = k - 1 - a - b;
                            const uint64_t box = (uint64_t{p.x} >> (32 - a) << b | uint64_t{p.y} >> (32 - b))
                                                     << c |
                                                 uint64_t{p.z} >> (32 - c);
                            ++counts[box];
                        }
                        ASSERT_EQ(counts, std::vector<int>(counts.size(), 2))
                            << first << ' ' << k << ' ' << a << ' ' << b;
                    }
                }
            }
        }
    }
}

TEST_F(SamplerTest, Every64StratifiedPointsFillTheGridInAnOrderOfTheirOwn) {
    for (const SampleOfPair& set : FEW_SETS) {
        const std::vector<uvec3> points = triples(SAMPLER_STRATIFIED, first_samples(set, 64 * 32));
        std::set<std::vector<uint32_t>> orders;
        for (size_t first = 0; first < points.size(); first += 64) {
            std::vector<uint32_t> cells, intervals;
            for (size_t i = first; i < first + 64; ++i) {
                cells.push_back(points[i].x >> 29 | points[i].y >> 29 << 3);
                intervals.push_back(points[i].z >> 26);
            }
            for (const std::vector<uint32_t>& order : {cells, intervals}) {
                EXPECT_EQ(std::set(order.begin(), order.end()).size(), 64u);
                orders.insert(order);
            }
        }
        EXPECT_EQ(orders.size(), 64u);
    }
}

}  // namespace
}  // namespace candela
