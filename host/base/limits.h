// Limits of users' requests that several folders of the code need.
#pragma once

#include <cstdint>

namespace candela {

// The most samples per pixel: counts are stored as 32-bit floats, which are exact up to this number.
inline constexpr uint32_t MAX_SPP = 1u << 24;

// The most bounces of a path, also of one without a limit.
inline constexpr uint32_t MAX_BOUNCES = 4096;

// The most pixels along a side of a picture.
inline constexpr uint32_t MAX_PICTURE_SIZE = 65536;

}  // namespace candela
