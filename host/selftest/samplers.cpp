// See samplers.h.
#include "selftest/samplers.h"

#include <bit>
#include <vector>

#include "base/text.h"
#include "probe/probe.h"
#include "probe/probes.h"
#include "probe/random.h"
#include "selftest/reference_sampler.h"
#include "shared/constants.h"

namespace candela {
namespace {

// The result of the probe `hash`.
struct Hashes {
    uvec3 pcg3d;
    uvec4 pcg4d;
    uint32_t laine_karras;
    uint32_t permutation;
    float unit;
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

uvec3 reference_triple(uint32_t sampler, const SampleOfPair& s) {
    switch (sampler) {
        case SAMPLER_INDEPENDENT:
            return reference::independent_triple(s.pixel, s.n, s.seed, s.pair);
        case SAMPLER_STRATIFIED:
            return reference::stratified_triple(s.pixel, s.n, s.seed, s.pair);
        default:
            return reference::sobol_triple(s.pixel, s.n, s.seed, s.pair);
    }
}

}  // namespace

Evidence test_integer_functions(const vk::Device& device) {
    const std::vector<SampleOfPair> items = samples_of_pairs();
    const std::vector<Hashes> results = probe<Hashes>(device, kernels::hash, items);
    Evidence evidence;
    for (size_t i = 0; i < items.size(); ++i) {
        const uvec4 v = std::bit_cast<uvec4>(items[i]);
        const Hashes& r = results[i];
        const uint32_t top_bits = v.x / 256;
        const auto expect = [&](const char* function, bool equal) {
            evidence.expect(equal, [&] {
                return concat(function, " of ", v.x, ' ', v.y, ' ', v.z, ' ', v.w,
                              " differs from the reference");
            });
        };
        expect("pcg3d", r.pcg3d == reference::pcg3d(uvec3(v)));
        expect("pcg4d", r.pcg4d == reference::pcg4d(v));
        expect("laine_karras", r.laine_karras == reference::laine_karras(v.x, v.y));
        expect("permute_64", r.permutation == reference::permute_64(v.x % 64, v.y));
        expect("unit_float", r.unit == float(top_bits) / 16777216.0f && r.unit < 1.0f);
    }
    return evidence;
}

Evidence test_sampler(const vk::Device& device, uint32_t sampler) {
    const std::vector<SampleOfPair> samples = samples_of_pairs();
    const std::vector<uvec3> results =
        probe<uvec3>(device, kernels::sampler, samples, sampler_constants(sampler));
    Evidence evidence;
    for (size_t i = 0; i < samples.size(); ++i) {
        const SampleOfPair& s = samples[i];
        const uvec3 expected = reference_triple(sampler, s);
        evidence.expect(results[i] == expected, [&] {
            return concat("sampler ", sampler, ", pixel ", s.pixel, ", n ", s.n, ", seed ", s.seed, ", pair ",
                          s.pair, ": ", results[i].x, ' ', results[i].y, ' ', results[i].z, " instead of ",
                          expected.x, ' ', expected.y, ' ', expected.z);
        });
    }
    return evidence;
}

}  // namespace candela
