// Denoising by variance: what a Vulkan device makes of a picture of few samples, by the variance of each
// pixel's mean.
//
// A pixel becomes a weighted mean of its surroundings. Weights fall with differences of albedo and normal,
// and with differences of irradiance (colour over albedo) that the variances do not explain. The result is
// blended with the noisy picture (blend.h), and so converges to it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "denoise/blend.h"
#include "image/image.h"
#include "vk/device.h"

namespace candela {

// Planes of width * height values, row-major.
struct NoisyPicture {
    uvec2 size{0, 0};
    RgbPlanes rgb;  // Linear radiance. Values that are not finite, or 2^40 times the level of the
                    // picture, count as missing and are filled from around.
    std::optional<RgbPlanes>
        variance;  // Of each pixel's mean. Where it is not finite, or without it, what surfaces of
                   // the same features show within 5 x 5 pixels takes its place.
    std::optional<RgbPlanes> albedo;  // Mean albedo; without it, textures are known only by their colour.
    std::optional<RgbPlanes> normal;  // Mean normal, at most 1 long.
    std::span<const float> alpha;     // May be empty. Filtered by the weights of the colour.
    std::span<const float> samples;   // Per pixel; may be empty: the noise of normals is then that of 16.
};

// Pixels along the edge of the squares that a device works on; 150 MiB.
inline constexpr uint32_t DENOISE_TILE = 768;

// Filters. The result does not depend on `tile`, the pixels along the edge of what the device works on at a
// time. A pixel depends on those up to 34 away, and on the level of the whole picture, so that a crop has
// other bits. Between tiles `keep_going` is asked; if it says no, nothing is returned. Throws an Error if the
// device is lost or has too little memory.
std::optional<Denoised> filter_by_variance(const vk::Device& device, const NoisyPicture& picture,
                                           uint32_t tile = DENOISE_TILE,
                                           const std::function<bool()>& keep_going = {});

// The same, blended with the noisy picture; but not if the picture has no variance.
std::optional<Denoised> denoise_by_variance(const vk::Device& device, const NoisyPicture& picture,
                                            uint32_t tile = DENOISE_TILE,
                                            const std::function<bool()>& keep_going = {});

}  // namespace candela
