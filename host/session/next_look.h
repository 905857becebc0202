// At which numbers of samples a rendering is looked at.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace candela {

// The samples per pixel of the next look at a picture that has `spp` of them: the next power of two, at least
// `first`, which is one, too, and at most `target`. It does not depend on time, so that a rendering always
// ends with the same samples.
inline uint32_t next_look(uint32_t spp, uint32_t target, uint32_t first = 1) {
    return std::min(std::max(std::bit_ceil(spp + 1), first), target);
}

}  // namespace candela
