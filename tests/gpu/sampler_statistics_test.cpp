// The samplers as random numbers: independent of each other where they must be, and how fast their errors
// fall.
#include <array>
#include <cmath>
#include <functional>

#include "base/statistics.h"
#include "gpu/sampler_fixture.h"

namespace candela {
namespace {

constexpr std::array ALL_SAMPLERS{SAMPLER_INDEPENDENT, SAMPLER_STRATIFIED, SAMPLER_SOBOL};

// Three words as a point of the unit cube; exact.
glm::dvec3 to_cube(uvec3 words) {
    return glm::dvec3(words) * 0x1p-32;
}

// Two sets of points that must be independent of each other, point by point.
struct Relation {
    const char* name;
    uint32_t right, down;  // To the other pixel.
    uint32_t seeds, pairs;
};

// Relations to the neighbours, and between the dimensions that one path uses together: pixel and lens, light
// and BSDF of one bounce, one dimension of two bounces.
constexpr std::array RELATIONS{
    Relation{"the pixel to the right", 1, 0, 0, 0},
    Relation{"the pixel below", 0, 1, 0, 0},
    Relation{"the pixel to the right and below", 1, 1, 0, 0},
    Relation{"the next seed", 0, 0, 1, 0},
    Relation{"the next pair", 0, 0, 0, 1},
    Relation{"the same pair of the next bounce", 0, 0, 0, PAIRS_PER_BOUNCE},
};

class SamplerStatisticsTest : public SamplerTest {
  protected:
    // Pixels of a picture of which every second row and column is used, so that no pixel is the neighbour of
    // another.
    static constexpr uint32_t SIZE = 256, PIXELS = SIZE * SIZE / 4;
    static constexpr uint32_t PAIR = 1;

    // Samples first, ..., first + count - 1 of these pixels, one after the other, or of what `to` relates to
    // them.
    std::vector<glm::dvec3> points(uint32_t sampler, uint32_t first, uint32_t count,
                                   const Relation& to) const {
        std::vector<SampleOfPair> samples;
        for (uint32_t n = first; n < first + count; ++n) {
            for (uint32_t y = to.down; y < SIZE; y += 2) {
                for (uint32_t x = to.right; x < SIZE; x += 2)
                    samples.push_back({x | y << 16, n, 5 + to.seeds, PAIR + to.pairs});
            }
        }
        std::vector<glm::dvec3> points;
        for (const uvec3 words : triples(sampler, samples))
            points.push_back(to_cube(words));
        return points;
    }
};

// For independent uniform u and v, 12 (u - 1/2) (v - 1/2) has the mean 0 and the variance 1.
double correlation_z(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b, int i, int k) {
    double sum = 0.0;
    for (size_t j = 0; j < a.size(); ++j)
        sum += 12.0 * (a[j][i] - 0.5) * (b[j][k] - 0.5);
    return sum / std::sqrt(double(a.size()));
}

double joint_uniformity(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b, int i, int k) {
    constexpr size_t CELLS = 16;
    std::vector<double> counts(CELLS * CELLS);
    for (size_t j = 0; j < a.size(); ++j)
        ++counts[size_t(a[j][i] * CELLS) * CELLS + size_t(b[j][k] * CELLS)];
    return pearson_p_value(counts, std::vector<double>(counts.size(), 1.0));
}

// One sample, seen over many pixels. No correlation, and no dependence that a histogram of both would show.
TEST_F(SamplerStatisticsTest, SamplesOfPixelsSeedsAndPairsAreIndependent) {
    const std::array<uint32_t, 3> indices{0, 5, 63};
    const double level =
        sidak_level(CHI_SQUARED_ALPHA, ALL_SAMPLERS.size() * indices.size() * (RELATIONS.size() * 9 + 3) * 2);
    for (const uint32_t sampler : ALL_SAMPLERS) {
        for (const uint32_t n : indices) {
            const std::vector<glm::dvec3> base = points(sampler, n, 1, {});
            const auto expect_independent = [&](const char* name, const std::vector<glm::dvec3>& other, int i,
                                                int k) {
                EXPECT_GT(normal_p_value(correlation_z(base, other, i, k)), level)
                    << "sampler " << sampler << ", n " << n << ", " << name << ' ' << i << ' ' << k;
                EXPECT_GT(joint_uniformity(base, other, i, k), level)
                    << "sampler " << sampler << ", n " << n << ", " << name << ' ' << i << ' ' << k;
            };
            for (const auto& [i, k] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)})
                expect_independent("words of one sample", base, i, k);
            for (const Relation& relation : RELATIONS) {
                const std::vector<glm::dvec3> other = points(sampler, n, 1, relation);
                for (const int i : {0, 1, 2}) {
                    for (const int k : {0, 1, 2})
                        expect_independent(relation.name, other, i, k);
                }
            }
        }
    }
}

// A picture shows the error of a pixel's first samples, which must not follow its neighbour's. For
// independent errors of any distribution, the correlation coefficient times the root of their number is
// nearly normal.
TEST_F(SamplerStatisticsTest, ErrorsOfPixelsSeedsAndPairsAreIndependent) {
    const double level = sidak_level(CHI_SQUARED_ALPHA, ALL_SAMPLERS.size() * RELATIONS.size());
    const auto errors = [&](uint32_t sampler, const Relation& relation) {
        const std::vector<glm::dvec3> at = points(sampler, 0, 16, relation);
        std::vector<double> sums(PIXELS);
        for (size_t j = 0; j < at.size(); ++j)
            sums[j % PIXELS] += at[j].x * at[j].y - 0.25;
        return sums;
    };
    for (const uint32_t sampler : ALL_SAMPLERS) {
        const std::vector<double> a = errors(sampler, {});
        for (const Relation& relation : RELATIONS) {
            const std::vector<double> b = errors(sampler, relation);
            double product = 0.0, of_a = 0.0, of_b = 0.0;
            for (size_t j = 0; j < a.size(); ++j) {
                product += a[j] * b[j];
                of_a += a[j] * a[j];
                of_b += b[j] * b[j];
            }
            const double z = product / std::sqrt(of_a * of_b) * std::sqrt(double(a.size()));
            EXPECT_GT(normal_p_value(z), level) << "sampler " << sampler << ", " << relation.name;
        }
    }
}

// Pairs are shuffled against each other, so that the first half of one does not go with the first half of
// another. Among the first 16 samples, 2 m and 2 m + 1 are in different halves of the square, along either
// axis; which of them is where depends on m by bits that are random and each pair's own. So the number of the
// 8 couples that are alike in two pairs has a binomial distribution: all would be alike, or none, if the
// pairs were visited in one order.
TEST_F(SamplerStatisticsTest, SobolPairsAreShuffledAgainstEachOther) {
    constexpr uint32_t COUPLES = 8;
    const std::array<Relation, 3> relations{RELATIONS[4], RELATIONS[5],
                                            Relation{"a pair far away", 0, 0, 0, 1000}};
    const double level = sidak_level(CHI_SQUARED_ALPHA, relations.size() * 4);
    const std::vector<double> binomial{1, 8, 28, 56, 70, 56, 28, 8, 1};
    for (const Relation& relation : relations) {
        std::vector<std::array<uint32_t, 4>> alike(PIXELS);
        const std::vector<glm::dvec3> a = points(SAMPLER_SOBOL, 0, 2 * COUPLES, {});
        const std::vector<glm::dvec3> b = points(SAMPLER_SOBOL, 0, 2 * COUPLES, relation);
        for (size_t j = 0; j < a.size(); ++j) {
            if (j / PIXELS % 2 != 0) continue;  // Sample 2 m speaks for its couple.
            for (const size_t axes : {0u, 1u, 2u, 3u})
                alike[j % PIXELS][axes] += (a[j][int(axes / 2)] < 0.5) == (b[j][int(axes % 2)] < 0.5);
        }
        for (const size_t axes : {0u, 1u, 2u, 3u}) {
            std::vector<double> counts(COUPLES + 1);
            for (const auto& of_pixel : alike)
                ++counts[of_pixel[axes]];
            EXPECT_GT(pearson_p_value(counts, binomial), level) << relation.name << ", axes " << axes;
        }
    }
}

// Slope of log(RMSE) over log(N) for N = 2^2 ... 2^10 samples of 1 / (1 + x + y), each from scrambles of its
// own.
double error_slope(const std::function<std::vector<uvec2>(const std::vector<SampleOfPair>&)>& pairs,
                   uint32_t scrambles) {
    const double exact = 3.0 * std::log(3.0) - 4.0 * std::log(2.0);
    double sum_kk = 0.0, sum_ke = 0.0;
    for (uint32_t k = 2; k <= 10; ++k) {
        std::vector<SampleOfPair> samples;
        for (uint32_t i = 0; i < scrambles << k; ++i)
            samples.push_back({i >> k, i & ((1u << k) - 1u), k, 3});
        std::vector<double> sums(scrambles);
        const std::vector<uvec2> words = pairs(samples);
        for (uint32_t i = 0; i < words.size(); ++i) {
            const glm::dvec2 at = glm::dvec2(words[i]) * 0x1p-32;
            sums[i >> k] += 1.0 / (1.0 + at.x + at.y);
        }
        RunningMoments squares;
        for (const double sum : sums)
            squares.add(std::pow(sum / double(1u << k) - exact, 2.0));
        const double centred = double(k) - 6.0;
        sum_kk += centred * centred;
        sum_ke += centred * 0.5 * std::log2(squares.mean());
    }
    return sum_ke / sum_kk;
}

// With R scrambles, the logarithm of the RMSE has a standard deviation of 1 / sqrt(2 R), or less if errors
// have lighter tails than normal ones; the slope's is that over log(2) sqrt(60), 60 being the sum of (k -
// 6)^2. For R = 256 it is 0.0082: a tolerance of 0.05 is 6 of them.
TEST_F(SamplerStatisticsTest, ErrorsOfIndependentSamplesFallLikeTheRootOfTheirNumber) {
    const double slope =
        error_slope([&](const auto& samples) { return pairs(SAMPLER_INDEPENDENT, samples); }, 256);
    EXPECT_NEAR(slope, -0.5, 0.05);
}

// The errors of scrambled nets fall like N^(-3/2), but for a logarithm, where the integrand is smooth.
// Ref: Owen 1997, Scrambled Net Variance for Integrals of Smooth Functions, Annals of Statistics 25.
TEST_F(SamplerStatisticsTest, ErrorsOfSobolSamplesFallFaster) {
    const double slope = error_slope([&](const auto& samples) { return pairs(SAMPLER_SOBOL, samples); }, 128);
    EXPECT_LE(slope, -1.2);
}

}  // namespace
}  // namespace candela
