// The samplers against a reference on the CPU, bit for bit, and the stratification that they promise.
#include <map>
#include <set>

#include "gpu/device_fixture.h"
#include "selftest/random.h"
#include "selftest/reference_sampler.h"

namespace candela {
namespace {

struct SampleOfPair {
    uint32_t pixel;  // x | y << 16
    uint32_t n;
    uint32_t seed;
    uint32_t pair;
};

// Corners and random values of all four counters.
std::vector<SampleOfPair> samples_of_pairs() {
    std::vector<SampleOfPair> samples;
    for (const uint32_t pixel : {0u, 1u, 0x00010000u, 0xFFFFFFFFu}) {
        for (const uint32_t n : {0u, 1u, 63u, 64u, 0xFFFFFFFFu}) {
            for (const uint32_t seed : {0u, 1u, 0xFFFFFFFFu}) {
                for (const uint32_t pair : {0u, 1u, 2u, 16389u})
                    samples.push_back({pixel, n, seed, pair});
            }
        }
    }
    Random random(2);
    for (int i = 0; i < 10000; ++i) {
        const uint32_t pixel = random.bits();
        const uint32_t n = random.bits() >> random.bits() % 32;
        samples.push_back({pixel, n, random.bits(), random.bits() % 100});
    }
    return samples;
}

class SamplerTest : public DeviceTest {
  protected:
    std::vector<uvec2> pairs(uint32_t sampler, const std::vector<SampleOfPair>& samples) const {
        return map<uvec2>(kernels::sampler, samples, {sampler});
    }
    // The first `count` points of a few (pixel, seed, pair), each a set of its own.
    std::vector<std::vector<uvec2>> point_sets(uint32_t sampler, uint32_t count) const {
        std::vector<std::vector<uvec2>> sets;
        for (const SampleOfPair set : {SampleOfPair{0, 0, 0, 0}, SampleOfPair{0x00050007, 0, 1, 2},
                                       SampleOfPair{0x04000300, 0, 99, 17}}) {
            std::vector<SampleOfPair> samples;
            for (uint32_t n = 0; n < count; ++n)
                samples.push_back({set.pixel, n, set.seed, set.pair});
            sets.push_back(pairs(sampler, samples));
        }
        return sets;
    }
};

TEST_F(SamplerTest, IntegerFunctionsMatchTheReference) {
    struct Hashes {
        uvec3 pcg3d;
        uvec4 pcg4d;
        uint32_t laine_karras;
        uint32_t permutation;
        float unit;
    };
    const std::vector<SampleOfPair> items = samples_of_pairs();
    const std::vector<Hashes> results = map<Hashes>(kernels::hash, items);
    for (size_t i = 0; i < items.size(); ++i) {
        const uvec4 v = std::bit_cast<uvec4>(items[i]);
        ASSERT_EQ(results[i].pcg3d, reference::pcg3d(uvec3(v)));
        ASSERT_EQ(results[i].pcg4d, reference::pcg4d(v));
        ASSERT_EQ(results[i].laine_karras, reference::laine_karras(v.x, v.y));
        ASSERT_EQ(results[i].permutation, reference::permute_64(v.x % 64, v.y));
        ASSERT_EQ(results[i].unit, float(v.x / 256) / 16777216.0f);
        ASSERT_LT(results[i].unit, 1.0f);
    }
}

TEST_F(SamplerTest, PairsMatchTheReference) {
    const std::vector<SampleOfPair> samples = samples_of_pairs();
    using Reference = uvec2 (*)(uint32_t, uint32_t, uint32_t, uint32_t);
    const std::map<uint32_t, Reference> references{{SAMPLER_INDEPENDENT, reference::independent_pair},
                                                   {SAMPLER_STRATIFIED, reference::stratified_pair},
                                                   {SAMPLER_SOBOL, reference::sobol_pair}};
    for (const auto& [sampler, expected] : references) {
        const std::vector<uvec2> results = pairs(sampler, samples);
        for (size_t i = 0; i < samples.size(); ++i) {
            const auto [pixel, n, seed, pair] = samples[i];
            ASSERT_EQ(results[i], expected(pixel, n, seed, pair))
                << "sampler " << sampler << ", pixel " << pixel << ", n " << n << ", seed " << seed
                << ", pair " << pair;
        }
    }
}

// A (0, 2)-net: every way to cut the square into 2^a x 2^b equal boxes has one of the 2^(a+b) points in each
// box.
void expect_net(std::span<const uvec2> points, uint32_t log2_count) {
    for (uint32_t a = 0; a <= log2_count; ++a) {
        const uint32_t b = log2_count - a;
        std::set<uint64_t> boxes;
        for (const uvec2 p : points)
            boxes.insert((uint64_t{p.x} >> (32 - a)) << b | uint64_t{p.y} >> (32 - b));
        ASSERT_EQ(boxes.size(), points.size()) << "2^" << a << " x 2^" << b << " boxes";
    }
}

TEST_F(SamplerTest, EveryAlignedRunOfSobolPointsIsANet) {
    for (const std::vector<uvec2>& points : point_sets(SAMPLER_SOBOL, 4096)) {
        for (uint32_t k = 0; k <= 12; ++k) {
            for (size_t first = 0; first < points.size(); first += size_t{1} << k) {
                expect_net(std::span(points).subspan(first, size_t{1} << k), k);
                if (k < 6 && first > 256) break;  // Short runs are many; the first ones say enough.
            }
        }
    }
}

TEST_F(SamplerTest, Every64StratifiedPointsFillTheGridInAnOrderOfTheirOwn) {
    for (const std::vector<uvec2>& points : point_sets(SAMPLER_STRATIFIED, 64 * 32)) {
        std::set<std::vector<uint32_t>> orders;
        for (size_t first = 0; first < points.size(); first += 64) {
            std::vector<uint32_t> order;
            for (size_t i = first; i < first + 64; ++i)
                order.push_back(points[i].x >> 29 | points[i].y >> 29 << 3);
            EXPECT_EQ(std::set(order.begin(), order.end()).size(), 64u);
            orders.insert(order);
        }
        EXPECT_EQ(orders.size(), 32u);
    }
}

}  // namespace
}  // namespace candela
