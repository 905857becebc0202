// The guarantee for denoised pictures: a blend with the noisy one, by how much of their difference noise
// explains.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "denoise/denoiser.h"

namespace candela {

// The weights of the noisy picture in the best blend with `denoised`, one per pixel, from 0 to 1.
//
// With d = denoised - noisy, V the variance of the noisy value and s the own weight, the blend that minimises
// the expected squared error weighs the noisy value by 1 - (1 - s) V / E d^2, whatever the bias of the
// denoised one. This is positive-part James-Stein shrinkage. E d^2 and V are means over 5 x 5 pixels,
// relative to the level of each. As samples are added, V falls and the bias stays, so that the blend
// converges to the noisy picture.
//
// Samples of low-discrepancy sequences err less than V says, and a bias could hide behind it. But noise
// differs from pixel to pixel, while a bias has the same sign along an edge: the weight is at least what the
// share of E d^2 says by which neighbours agree, beyond 1.5 standard deviations of what agrees by chance.
// Noise with a heavy tail still agrees in spots, while a bias is as long as an edge: of either share counts
// what is as long as a line, of 3 pixels and of 7. Both become stricter with `samples_per_pixel` (0 if
// unknown), when there is more to lose than to win: up to 16 samples, V counts for 1.2 and the share for 1;
// at 256, for 1 and 4; from 4096 on, for 0.1 and 4. Few samples tell V badly, and 0 where they found nothing:
// up to 256, a V below the mean of the pixels around whose denoised values are similar is raised to that.
//
// A lone outlier has its own say: as far as its V, relative to the denoised value, is above four times the
// noise around, it counts beside the bias b^2 that the window shows, and the weight is b^2 / (b^2 + V). But
// what its own V does not explain of its own d^2 is no noise, and stays: a lamp of one pixel is no outlier.
//
// Where V is infinite (below two samples) or no number, nothing is known and the weight is 0. So it is where
// only the noisy value is not finite, or beyond 2^40 times the picture's level; where the denoised one is
// not, it is 1. Where nothing around has noise, it is exactly 1.
//
// Ref: Stein, "Estimation of the Mean of a Multivariate Normal Distribution" (1981); James, Stein,
// "Estimation with Quadratic Loss" (1961).
std::vector<float> noisy_weights(uvec2 size, const RgbPlanes& noisy, const RgbPlanes& variance,
                                 const Denoised& denoised, double samples_per_pixel = 0.0);

// Replaces `denoised` by its blend with the noisy picture; `alpha` may be empty. A weight of 1 gives the
// noisy value, and a weight of 0 the denoised one, bit by bit.
void blend(const std::vector<float>& noisy_weights, const RgbPlanes& noisy, std::span<const float> alpha,
           Denoised& denoised);

// Replaces `denoised` by its best blend with the noisy picture, if the variance of that is known.
void blend_with(const NoisyPicture& noisy, Denoised& denoised);

}  // namespace candela
