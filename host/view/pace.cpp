// See pace.h.
#include "view/pace.h"

#include <algorithm>

namespace candela {

uvec2 scaled_size(uvec2 size, uint32_t scale) {
    return max(size / scale, uvec2(1));
}

uint32_t next_scale(uint32_t scale, double seconds) {
    constexpr double CLEARLY = 0.8;  // So that the scale does not oscillate.
    if (seconds > MOVING_SECONDS) return std::min(2 * scale, COARSEST_SCALE);
    return 4.0 * seconds < CLEARLY * MOVING_SECONDS ? std::max(scale / 2, 1u) : scale;
}

}  // namespace candela
