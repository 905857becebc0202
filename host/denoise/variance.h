// Denoising by variance: what a Vulkan device makes of a picture of few samples, by the variance of each
// pixel's mean.
//
// A pixel becomes a weighted mean of its surroundings. Weights fall with differences of albedo and normal,
// and with differences of irradiance (colour over albedo) that the variances do not explain. The result is
// to be blended with the noisy picture (blend.h), and then converges to it.
#pragma once

#include <cstdint>

#include "denoise/denoiser.h"
#include "vk/device.h"

namespace candela {

// Pixels along the edge of the squares that a device works on; 150 MiB.
inline constexpr uint32_t DENOISE_TILE = 768;

// Filters. Values that are not finite, or 2^40 times the level of the picture, count as missing and are
// filled from around; alpha is filtered by the weights of the colour. Where a variance is not finite, or
// without it, what surfaces of the same features show within 5 x 5 pixels takes its place; without an albedo,
// textures are known only by their colour; without the numbers of samples, the noise of normals is that
// of 16. The result does not depend on `tile`, the pixels along the edge of what the device works on at a
// time. A pixel depends on those up to 34 away, and on the level of the whole picture, so that a crop has
// other bits. Throws an Error if the device is lost or has too little memory.
Denoised filter_by_variance(const vk::Device& device, const NoisyPicture& picture,
                            uint32_t tile = DENOISE_TILE);

}  // namespace candela
