// The denoiser by variance, our own, on any Vulkan device.
#pragma once

#include <functional>
#include <memory>

#include "denoise/denoiser.h"
#include "vk/device.h"

namespace candela {

// `open` is called for each picture, by the thread that denoises it, and gives a device that nothing else
// uses meanwhile; it throws what vk::Device throws. See filter_by_variance().
std::unique_ptr<Denoiser> make_variance(std::function<const vk::Device&()> open);

// What it needs at most, besides the picture and its denoised planes [bytes].
inline constexpr uint64_t VARIANCE_BYTES = uint64_t{256} << 20;

}  // namespace candela
