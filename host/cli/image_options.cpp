// See image_options.h.
#include "cli/image_options.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/arguments.h"
#include "image/image_io.h"

namespace candela {

static_assert(MAX_EXPOSURE_EV == 100.0f, "the message on --exposure says so");

static std::optional<double> parse_exposure(const std::string& text) {
    const auto value = parse_number(text);
    return value && std::abs(*value) <= double(MAX_EXPOSURE_EV) ? value : std::nullopt;
}

void DevelopmentOptions::add_to(CLI::App& app) {
    add_value(app, "--exposure", exposure, parse_exposure, "a number from -100 to 100",
              "PNG: multiply by 2^EV before the tone map (default: 0)")
        ->type_name("EV");
    add_choice(app, "--tonemap", tonemap, TONEMAP_NAMES, "PNG: tone map (default: linear, which clamps)");
}

void ImageOutputs::add_to(CLI::App& app) {
    app.add_option("-o,--output", files, "Image to write, .exr or .png; repeat it for several")
        ->type_name("FILE")
        ->take_all()
        ->allow_extra_args(false);
    app.add_flag("--half", half, "EXR: R G B A and Albedo as 16-bit floats (default: 32-bit)");
    development.add_to(app);
}

void ImageOutputs::add_aovs_to(CLI::App& app) {
    add_value(app, "--aov", aovs, parse_aovs, std::string("all, none or a list of ") + AOV_NAMES,
              "EXR: none, all (default) or a list of " + std::string(AOV_NAMES))
        ->type_name("LIST");
}

AovSelection ImageOutputs::written_aovs() const {
    const bool exr = std::ranges::any_of(
        files, [](const std::string& path) { return image_format(path) == ImageFormat::exr; });
    return exr ? aovs : AovSelection{};
}

}  // namespace candela
