// See srgb_codes.h.
#include "image/srgb_codes.h"

#include <cmath>

#include "base/color.h"

namespace candela {
namespace {

uint32_t nearest_code(uint32_t bits) {
    return uint32_t(std::lround(255.0f * srgb_encode(std::bit_cast<float>(bits))));
}

}  // namespace

const SrgbCodes& SrgbCodes::table() {
    static const SrgbCodes codes;
    return codes;
}

SrgbCodes::SrgbCodes() {
    for (uint32_t bin = 0; bin < BINS; ++bin)
        first_[bin] = uint8_t(nearest_code(bin << BIN_SHIFT));
    for (uint32_t code = 1; code <= 255; ++code) {
        // By bisection: floats from 0 on are in the order of their bits.
        uint32_t below = 0, at = ONE;
        while (at - below > 1) {
            const uint32_t middle = below + (at - below) / 2;
            (nearest_code(middle) < code ? below : at) = middle;
        }
        least_[code] = std::bit_cast<float>(at);
    }
    least_[256] = 2.0f;
}

}  // namespace candela
