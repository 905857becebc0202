// See choose_denoiser.h.
#include "denoise/choose_denoiser.h"

#include <utility>

#include "base/error.h"

namespace candela {

std::unique_ptr<Denoiser> choose_denoiser(DenoiserChoice choice, DenoiserQuality quality,
                                          std::function<const vk::Device&()> open) {
    if (choice == DenoiserChoice::oidn) return make_oidn(oidn_candidates(), quality);
    if (choice == DenoiserChoice::automatic) {
        try {
            return make_oidn(oidn_candidates(), quality);
        } catch (const Error&) {  // It is missing, or does not run here.
        }
    }
    return make_variance(std::move(open));
}

}  // namespace candela
