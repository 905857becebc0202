// What the viewer decides by numbers alone: how coarse the picture is while the camera moves, and how large
// the error of the picture is.
#pragma once

#include <optional>

#include "base/math.h"
#include "render/accumulation.h"

namespace candela {

// While the camera moves, the first sample of every pixel shall be there after so many seconds: with a
// picture's development, the panel and the window's own work that makes more than ten pictures per second.
inline constexpr double MOVING_SECONDS = 0.05;

// The coarsest moving picture has an eighth of the pixels along each side; the first one has a quarter.
inline constexpr uint32_t COARSEST_SCALE = 8;
inline constexpr uint32_t FIRST_SCALE = 4;

// While the camera moves, the sides of the picture are divided by a power of two. By what the next one's are,
// if the last one's were by `scale` and its first samples took so many seconds: by more if that was longer
// than MOVING_SECONDS, by less if four times as many pixels would clearly not take longer.
uint32_t next_scale(uint32_t scale, double seconds);

// `size` divided by `scale`, at least 1 in each direction.
uvec2 scaled_size(uvec2 size, uint32_t scale);

// The estimated relative error of the picture: the root of the mean, over pixels and channels, of V / (x^2 +
// 0.01 m^2), where x is the mean of a pixel's samples, V its variance and m the mean of the picture, as in
// the relMSE of `candela bench`. Of the pixels that have two samples at least; nothing if there is none, or
// for a black picture. The variance is that of independent samples: with the other samplers the error is
// usually smaller.
std::optional<double> relative_error(const Accumulation& state);

}  // namespace candela
