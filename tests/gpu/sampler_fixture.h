// What the tests of samplers share: pairs of random words from the device.
#pragma once

#include <vector>

#include "gpu/device_fixture.h"

namespace candela {

class SamplerTest : public DeviceTest {
  protected:
    // One pair of words for each sample; `sampler` is one of SAMPLER_*.
    std::vector<uvec2> pairs(uint32_t sampler, const std::vector<SampleOfPair>& samples) const {
        return map<uvec2>(kernels::sampler, samples, sampler_constants(sampler));
    }
    // The first `count` pairs of a (pixel, seed, pair).
    std::vector<uvec2> first_points(uint32_t sampler, SampleOfPair set, uint32_t count) const {
        std::vector<SampleOfPair> samples(count, set);
        for (uint32_t n = 0; n < count; ++n)
            samples[n].n = n;
        return pairs(sampler, samples);
    }
};

}  // namespace candela
