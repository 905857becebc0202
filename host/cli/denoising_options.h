// The options by which commands denoise.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "denoise/choose_denoiser.h"
#include "image/image.h"

namespace candela {

// What the denoised planes of a pixel take [bytes].
inline constexpr uint32_t DENOISED_BYTES = 4 * sizeof(float);

// How an image was denoised.
struct DenoisingRecord {
    std::string denoiser;     // As on the command line, but never auto.
    std::string description;  // "Open Image Denoise 2.5.1".
    double seconds = 0.0;     // Wall time.
};

struct DenoisingOptions {
    DenoiserChoice choice = DenoiserChoice::none;
    DenoiserQuality quality = DenoiserQuality::high;
    std::shared_ptr<Denoiser> denoiser{};  // See load().

    // Declares them on `app`, for images that may be denoised, or for those that are; this object must not
    // move.
    void add_to(CLI::App& app);
    void add_required_to(CLI::App& app);
    // The same for a window, whose switch denoises if the option does not.
    void add_shown_to(CLI::App& app);

    bool is_on() const { return choice != DenoiserChoice::none; }
    // Loads the denoiser, if one is asked for. Throws Error (request) if it is missing. `open`: see
    // make_variance().
    void load(std::function<const vk::Device&()> open);
    // The denoiser; if none is asked for, the best.
    std::unique_ptr<Denoiser> make(std::function<const vk::Device&()> open) const;

    // Adds the image's denoised layers, by the denoiser that was loaded. Throws Error as add_denoised() does;
    // messages call the image `name`.
    DenoisingRecord denoise(Image& image, bool with_alpha, const std::string& name) const;
    // The same for a picture that must not be lost: a failure is a warning, and the picture stays noisy. Does
    // nothing if nothing was loaded.
    std::optional<DenoisingRecord> denoise_or_warn(Image& image, bool with_alpha) const;
};

}  // namespace candela
