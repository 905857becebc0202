// How coarse the picture is while the camera moves.
#pragma once

#include <cstdint>

#include "base/math.h"

namespace candela {

// While the camera moves, every pixel should have its first sample after this many seconds: with the
// picture's development, the panel and the window's own work, that makes more than ten pictures per second.
inline constexpr double MOVING_SECONDS = 0.05;

// The coarsest moving picture has an eighth of the pixels along each side; the first one has a quarter.
inline constexpr uint32_t COARSEST_SCALE = 8;
inline constexpr uint32_t FIRST_SCALE = 4;

// While the camera moves, the sides of the picture are divided by a power of two. Returns the divisor of the
// next picture, if the last one's was `scale` and its first samples took `seconds`: larger if that exceeded
// MOVING_SECONDS, smaller if four times as many pixels clearly would not exceed it.
uint32_t next_scale(uint32_t scale, double seconds);

// `size` divided by `scale`, at least 1 in each direction.
uvec2 scaled_size(uvec2 size, uint32_t scale);

}  // namespace candela
