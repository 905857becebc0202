// Which denoiser is used.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include "denoise/denoiser.h"
#include "denoise/oidn.h"
#include "denoise/variance_denoiser.h"

namespace candela {

enum class DenoiserChoice { none, automatic, oidn, variance };

// The words for a denoiser that is asked for.
inline constexpr std::array<std::pair<std::string_view, DenoiserChoice>, 3> DENOISER_NAMES{
    {{"auto", DenoiserChoice::automatic},
     {"oidn", DenoiserChoice::oidn},
     {"variance", DenoiserChoice::variance}}};

// The denoiser for a choice that is not `none`; `automatic` is Open Image Denoise, or else the one by
// variance. Throws Error (request) if the library that is asked for is missing. `open`: see make_variance().
std::unique_ptr<Denoiser> choose_denoiser(DenoiserChoice choice, DenoiserQuality quality,
                                          std::function<const vk::Device&()> open);

// What any of them needs at most, besides the picture and its denoised planes [bytes].
inline constexpr uint64_t DENOISER_BYTES = std::max(OIDN_BYTES, VARIANCE_BYTES);

}  // namespace candela
