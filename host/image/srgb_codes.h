// Codes of sRGB with 8 bits, by a table: the power would take most of the time of developing a picture.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace candela {

class SrgbCodes {
  public:
    // The only one; made by the first call.
    static const SrgbCodes& table();

    // The code nearest to srgb_encode() of light from 0 to 1; 0 below, and 255 above.
    uint8_t operator()(float light) const {
        if (!(light > 0.0f)) return 0;
        if (light >= 1.0f) return 255;
        const uint8_t code = first_[std::bit_cast<uint32_t>(light) >> BIN_SHIFT];
        return uint8_t(code + (light >= least_[code + size_t{1}]));
    }

  private:
    SrgbCodes();

    // Floats that differ only in their lower bits share a bin. 8 bits of the mantissa are left, so that a
    // bin's ends are less than a code apart.
    static constexpr uint32_t BIN_SHIFT = 15;
    static constexpr uint32_t ONE = std::bit_cast<uint32_t>(1.0f);
    static constexpr size_t BINS = (ONE >> BIN_SHIFT) + 1;

    std::array<uint8_t, BINS> first_{};  // The code of the least float of each bin.
    std::array<float, 257> least_{};  // The least light of each code from 1 on; more than 1 after the last.
};

}  // namespace candela
