// The distance of an image from its expectation, as one number: measured against a reference, or estimated
// from two stages or two halves of one rendering.
#pragma once

#include <cstdint>
#include <optional>

#include "image/image.h"

namespace candela {

// Relative mean squared error: the mean over pixels and channels of (x - r)^2 / (r^2 + 0.01 m^2), r the
// reference's value and m the mean of all values r, which is not 0. So it does not depend on the unit of
// radiance, and black pixels do not outweigh all others. Both have the same number of pixels.
double relative_mse(const RgbPlanes& image, const RgbPlanes& reference);

// The term 0.01 m^2 of relative_mse(), for a reference, or for an image used as one.
double darkness_of(const RgbPlanes& reference);

// No error should be estimated from fewer samples per pixel: they may not have found the light yet.
inline constexpr uint32_t MIN_ESTIMATED_SPP = 16;

// Estimates the relative error of `now`, the square root of relative_mse() to a perfect reference, from how
// far it moved while the samples were doubled: `before` is the image of the first half of them. Both have R,
// G, B and SampleCount.V. Nothing if a pixel of `now` does not hold twice the samples of `before`, if one has
// none, or if the image is black.
//
// Let v(n) be the variance of a pixel with n samples. If both halves have the same variance, the image moves
// by v(n/2) - v(n) in the mean square, however they are correlated. This is v(n) itself if v falls as 1/n, as
// it does for independent samples; where it falls as n^-p, with p > 1, it is 2^p - 1 times v(n), and the
// estimate is too large by the square root of that: it errs on the safe side. No estimate includes light that
// no sample has found yet.
std::optional<double> estimate_relative_error(const Image& before, const Image& now);

// The same for `mean`, the plain mean of `half` and another, independent image: in the mean square, the mean
// is as far from `half` as from its expectation, for all samplers and variances. Both have R, G and B.
// Nothing if the mean is black.
std::optional<double> estimate_relative_error_by_half(const Image& half, const Image& mean);

}  // namespace candela
