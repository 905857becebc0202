// What the tests of samplers share: random words from the device.
#pragma once

#include <vector>

#include "gpu/device_fixture.h"

namespace candela {

class SamplerTest : public DeviceTest {
  protected:
    // Three words for each sample; `sampler` is one of SAMPLER_*.
    std::vector<uvec3> triples(uint32_t sampler, const std::vector<SampleOfPair>& samples) const {
        return map<uvec3>(kernels::sampler, samples, sampler_constants(sampler));
    }
    // The pairs alone.
    std::vector<uvec2> pairs(uint32_t sampler, const std::vector<SampleOfPair>& samples) const {
        std::vector<uvec2> pairs;
        for (const uvec3 words : triples(sampler, samples))
            pairs.emplace_back(words.x, words.y);
        return pairs;
    }
    // The first `count` pairs of a (pixel, seed, pair).
    std::vector<uvec2> first_points(uint32_t sampler, SampleOfPair set, uint32_t count) const {
        return pairs(sampler, first_samples(set, count));
    }
    static std::vector<SampleOfPair> first_samples(SampleOfPair set, uint32_t count) {
        std::vector<SampleOfPair> samples(count, set);
        for (uint32_t n = 0; n < count; ++n)
            samples[n].n = n;
        return samples;
    }
};

}  // namespace candela
