// The numbers of samples at which the error of a rendering is measured.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace candela {

// The samples per pixel of the next look at a picture that has `spp`: the next power of two, at least `first`
// (also a power of two) and at most `target`. It does not depend on time, so that a rendering always ends
// with the same samples.
inline uint32_t next_look(uint32_t spp, uint32_t target, uint32_t first = 1) {
    return std::min(std::max(std::bit_ceil(spp + 1), first), target);
}

}  // namespace candela
