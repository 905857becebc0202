// Tests exponentials and the logarithm on the device against the standard library's in double precision.
#pragma once

#include <vector>

#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// log1p_nonpositive, exp_nonpositive and expm1_nonpositive of one number.
struct Exponentials {
    float log1p, exp, expm1;
};
std::vector<Exponentials> run_exponentials(const vk::Device& device, const std::vector<float>& x);

// Results must be right to the last few bits for numbers of every size, and around the boundaries of the
// approximations.
Evidence test_logarithm(const vk::Device& device);
Evidence test_exponentials(const vk::Device& device);

}  // namespace candela
