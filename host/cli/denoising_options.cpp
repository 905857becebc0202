// See denoising_options.h.
#include "cli/denoising_options.h"

#include <chrono>
#include <utility>

#include "base/caught_error.h"
#include "cli/arguments.h"
#include "cli/console.h"
#include "denoise/denoise_image.h"

namespace candela {
namespace {

constexpr Choices<DenoiserChoice, 4> CHOICE_NAMES{{{"auto", DenoiserChoice::automatic},
                                                   {"oidn", DenoiserChoice::oidn},
                                                   {"variance", DenoiserChoice::variance},
                                                   {"none", DenoiserChoice::none}}};
constexpr Choices<DenoiserQuality, 3> QUALITY_NAMES{{{"fast", DenoiserQuality::fast},
                                                     {"balanced", DenoiserQuality::balanced},
                                                     {"high", DenoiserQuality::high}}};

void add_quality(CLI::App& app, DenoiserQuality& quality) {
    add_choice(app, "--denoise-quality", quality, QUALITY_NAMES, "How long oidn may take (default: high)");
}

}  // namespace

void DenoisingOptions::add_to(CLI::App& app) {
    CLI::Option* const denoise = add_choice(
        app, "--denoise", choice, CHOICE_NAMES,
        "Denoise PNG, JPEG and WebP; EXR: add the layers Denoised. oidn: by Open Image Denoise; variance: by "
        "candela itself, on its device; auto: by the first of them that is there (default: none)");
    add_quality(app, quality);
    app.get_option("--denoise-quality")->needs(denoise);
}

void DenoisingOptions::add_required_to(CLI::App& app) {
    choice = DenoiserChoice::automatic;
    add_choice(
        app, "--denoise", choice, DENOISER_NAMES,
        "How: by Open Image Denoise, by candela itself, or by the first of them that is there (default: "
        "auto)");
    add_quality(app, quality);
}

void DenoisingOptions::add_shown_to(CLI::App& app) {
    CLI::Option* const denoise = add_choice(
        app, "--denoise", choice, CHOICE_NAMES,
        "Show the picture at rest denoised, as N does at any time: by oidn (Open Image Denoise), by variance "
        "(candela itself), or auto, the first of them that is there (default: none)");
    add_quality(app, quality);
    app.get_option("--denoise-quality")->needs(denoise);
}

std::unique_ptr<Denoiser> DenoisingOptions::make(std::function<const vk::Device&()> open) const {
    return choose_denoiser(is_on() ? choice : DenoiserChoice::automatic, quality, std::move(open));
}

void DenoisingOptions::load(std::function<const vk::Device&()> open) {
    if (is_on()) denoiser = make(std::move(open));
}

DenoisingRecord DenoisingOptions::denoise(Image& image, bool with_alpha, const std::string& name) const {
    const auto start = std::chrono::steady_clock::now();
    add_denoised(image, *denoiser, with_alpha, name);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return {.denoiser = denoiser->name(), .description = denoiser->description(), .seconds = seconds.count()};
}

std::optional<DenoisingRecord> DenoisingOptions::denoise_or_warn(Image& image, bool with_alpha) const {
    if (denoiser == nullptr) return std::nullopt;
    try {
        return denoise(image, with_alpha, "the picture");
    } catch (...) {
        print_warning("the picture stays noisy: " + std::string(caught_error().what()));
        return std::nullopt;
    }
}

}  // namespace candela
