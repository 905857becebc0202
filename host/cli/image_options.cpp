// See image_options.h.
#include "cli/image_options.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/arguments.h"
#include "image/image_io.h"

namespace candela {

static_assert(MAX_EXPOSURE_EV == 100.0f, "the message on --exposure says so");

static std::optional<Exposure> parse_exposure(const std::string& text) {
    const auto value = parse_number(text);
    if (!value || std::abs(*value) > double(MAX_EXPOSURE_EV)) return std::nullopt;
    return Exposure{.ev = *value};
}

static std::optional<Exposure> parse_exposure_or_auto(const std::string& text) {
    if (text == "auto") return Exposure{.automatic = true};
    return text == "first" ? Exposure{.automatic = true, .of_first = true} : parse_exposure(text);
}

static_assert(AUTO_PERCENTILE == 95.0 && AUTO_LUMINANCE == 0.8, "the description of --exposure says so");

void DevelopmentOptions::add_to(CLI::App& app, bool with_automatic) {
    constexpr const char* NUMBER = "a number from -100 to 100";
    if (with_automatic) {
        add_value(app, "--exposure", exposure, parse_exposure_or_auto,
                  std::string("auto, first or ") + NUMBER,
                  "PNG, JPEG, WebP: multiply by 2^EV before the tone map (default: 0); auto brings the 95th "
                  "percentile of luminance to 0.8; first does so for the first of several pictures, and "
                  "develops all others alike")
            ->type_name("EV|auto|first");
    } else {
        add_value(app, "--exposure", exposure, parse_exposure, NUMBER,
                  "PNG: multiply by 2^EV before the tone map (default: 0)")
            ->type_name("EV");
    }
    add_choice(app, "--tonemap", tonemap, TONEMAP_NAMES,
               with_automatic ? "PNG, JPEG, WebP: tone map (default: linear, which clamps)"
                              : "PNG: tone map (default: linear, which clamps)");
}

ImageFormat output_format(const std::string& path) {
    return path == STDOUT ? ImageFormat::exr : image_format(path);
}

void ImageOutputs::add_to(CLI::App& app) {
    app.add_option(
           "-o,--output", files,
           "Image to write, .exr, .png, .jpg or .webp, or - for EXR on standard output; repeat it for "
           "several")
        ->type_name("FILE|-")
        ->take_all()
        ->allow_extra_args(false);
    app.add_flag("--half", half, "EXR: R G B A and Albedo as 16-bit floats (default: 32-bit)");
    development.add_to(app, true);
    screen.add_to(app);
    data.add_to(app);
}

void ImageOutputs::add_aovs_to(CLI::App& app) {
    add_value(app, "--aov", aovs, parse_aovs, std::string("all, none or a list of ") + AOV_NAMES + ",motion",
              "EXR: none, all or a list of " + std::string(AOV_NAMES) +
                  " (default: the first six), and, with --frames, motion")
        ->type_name("LIST");
}

AovSelection ImageOutputs::written_aovs() const {
    const bool exr = std::ranges::any_of(
        files, [](const std::string& path) { return output_format(path) == ImageFormat::exr; });
    AovSelection written = exr ? aovs : AovSelection{};
    data.add_layers_to(written);
    written.transmission = screen.backdrop() == Backdrop::transmitted;
    return written;
}

AovSelection ImageOutputs::rendered_aovs() const {
    AovSelection rendered = written_aovs();
    rendered.denoising |= denoising.is_on();
    rendered.variance |= denoising.is_on();
    rendered.sample_count |= denoising.is_on();
    return rendered;
}

std::optional<DenoisingRecord> ImageOutputs::denoise(Image& image) const {
    std::optional<DenoisingRecord> record = denoising.denoise_or_warn(image, shows_alpha(image));
    const AovSelection written = written_aovs();
    std::erase_if(image.channels, [&](const Channel& channel) {
        return (!written.denoising && channel.name.starts_with("Denoising")) ||
               (!written.variance && channel.name.starts_with("Variance.")) ||
               (!written.sample_count && channel.name.starts_with("SampleCount."));
    });
    return record;
}

bool ImageOutputs::shows_alpha(const Image& image) const {
    return screen.background || default_background(image) != nullptr;
}

std::vector<ImageOutputs::Output> ImageOutputs::outputs() const {
    std::vector<Output> all;
    for (const std::string& file : files)
        all.push_back({"-o", file});
    for (const DataFile& file : data.files())
        all.push_back({file.option, file.name});
    return all;
}

ImageOutputs ImageOutputs::renamed(const std::vector<std::string>& names) const {
    ImageOutputs result = *this;
    std::copy_n(names.begin(), files.size(), result.files.begin());
    result.data.rename(names.data() + files.size());
    return result;
}

void ImageOutputs::check_name(size_t i, const std::string& name) const {
    if (i < files.size()) {
        output_format(name);
        return;
    }
    DataFile file = data.files()[i - files.size()];
    file.name = name;
    check_data_name(file);
}

bool ImageOutputs::uses_stdout() const {
    return std::ranges::find(files, STDOUT) != files.end();
}

ImageOutputs ImageOutputs::exposed_for(const Image& image) const {
    ImageOutputs result = *this;
    if (development.exposure.automatic) result.development.exposure = {.ev = double(auto_exposure(image))};
    return result;
}

}  // namespace candela
