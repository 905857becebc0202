// See choose_denoiser.h.
#include "denoise/choose_denoiser.h"

namespace candela {

// The way without a library.
static std::unique_ptr<Denoiser> make_variance() {
    return nullptr;
}

ChosenDenoiser choose_denoiser(DenoiserChoice choice, DenoiserQuality quality) {
    ChosenDenoiser chosen;
    if (choice != DenoiserChoice::variance) {
        try {
            chosen.denoiser = make_oidn(oidn_candidates(), quality);
            return chosen;
        } catch (const Error& error) {
            if (choice == DenoiserChoice::oidn) throw;
            chosen.why_not_oidn = error;
        }
    }
    chosen.denoiser = make_variance();
    if (chosen.denoiser == nullptr && choice == DenoiserChoice::variance) {
        throw Error("--denoise variance: this program does not have it; use --denoise oidn",
                    ErrorKind::request);
    }
    return chosen;
}

}  // namespace candela
