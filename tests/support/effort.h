// The number of the tests' samples: one of two fixed sizes, by the variable CANDELA_TEST_EFFORT, never by a
// clock.
#pragma once

#include <algorithm>

#include "selftest/effort.h"

namespace candela {

// "quick" or, unless the variable is set, "full". The first call says on stdout which.
Effort test_effort();

// The samples per pixel, or rays, to use instead of `full`: at least a few, so that they have a variance.
inline uint32_t samples(uint32_t full) {
    return std::max(sized(test_effort(), full), std::min(full, 8u));
}

}  // namespace candela
