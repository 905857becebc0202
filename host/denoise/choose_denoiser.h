// Which denoiser is used.
#pragma once

#include <memory>
#include <optional>

#include "base/error.h"
#include "denoise/denoiser.h"
#include "denoise/oidn.h"

namespace candela {

enum class DenoiserChoice { none, automatic, oidn, variance };

struct ChosenDenoiser {
    std::unique_ptr<Denoiser> denoiser;   // None if `automatic` finds none.
    std::optional<Error> why_not_oidn{};  // Of `automatic`, if it is another.
};

// The denoiser for a choice that is not `none`; for `automatic`, the best that is there. Throws Error
// (request) if the one that is asked for is missing.
ChosenDenoiser choose_denoiser(DenoiserChoice choice, DenoiserQuality quality);

}  // namespace candela
