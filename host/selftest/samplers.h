// Tests the random numbers of the device against the reference on the CPU, bit for bit.
#pragma once

#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// Hashes, permutations, and the conversion of words to floats.
Evidence test_integer_functions(const vk::Device& device);

// The three words of a sampler (SAMPLER_*).
Evidence test_sampler(const vk::Device& device, uint32_t sampler);

}  // namespace candela
