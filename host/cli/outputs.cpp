// Writes images with their attributes.
#include "cli/outputs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "base/cpu_time.h"
#include "base/file.h"
#include "cli/attempts.h"
#include "cli/console.h"
#include "denoise/denoise_image.h"
#include "image/image_io.h"

namespace candela {
namespace {

// Marks R G B A, albedos and what is denoised as 16-bit. A channel whose values exceed 16 bits keeps 32, with
// a warning: no sample may be lost.
void use_half(Image& image) {
    constexpr float LARGEST_HALF = 65504.0f;
    constexpr std::string_view COLOUR_CHANNELS[] = {"R", "G", "B", "A", "Albedo.R", "Albedo.G", "Albedo.B"};
    for (Channel& channel : image.channels) {
        const bool is_colour =
            std::ranges::find(COLOUR_CHANNELS, channel.name) != std::end(COLOUR_CHANNELS) ||
            (channel.name.starts_with("DenoisingAlbedo.") && channel.name != DENOISING_ALBEDO_VARIANCE) ||
            is_denoised_channel(channel.name);
        if (!is_colour) continue;
        channel.half = std::ranges::all_of(
            channel.values, [](float v) { return !std::isfinite(v) || std::abs(v) <= LARGEST_HALF; });
        if (!channel.half) {
            print_warning("channel " + channel.name +
                          " holds values beyond 65504, the largest 16-bit float; it is written with 32 bits");
        }
    }
}

void print_bytes(const std::filesystem::path& /*path*/, std::string_view bytes) {
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    flush_results();
}

// Returns the CPU time of all but developing [s].
double write_image(const ImageOutputs& outputs, const std::string& path, Image& image, FileWriter write) {
    const ImageFormat format = output_format(path);
    const CpuWatch all;
    if (format == ImageFormat::exr) {
        write_exr(path, image, path == STDOUT ? print_bytes : write);
        return all.seconds();
    }
    const DevelopmentOptions& development = outputs.development;
    const DenoisedView denoised(image);
    const TexelImage picture =
        outputs.screen.develop(image, format, development.tonemap, float(development.exposure.ev));
    const CpuWatch encoding;
    write_picture(path, picture, outputs.screen.notes(image), write);
    return encoding.seconds();
}

}  // namespace

void check_formats(const ImageOutputs& outputs) {
    if (outputs.outputs().empty()) {
        throw Error("no output given; use -o FILE.exr, -o FILE.png, or both", ErrorKind::request);
    }
    for (const std::string& path : outputs.files) {
        if (output_format(path) == ImageFormat::jpeg && outputs.screen.background == "transparent") {
            throw Error("--background: JPEG has no alpha for " + quoted(std::filesystem::path(path)) +
                            "; write .png or .webp, or give a colour such as '#ffffff'",
                        ErrorKind::request);
        }
    }
    for (const DataFile& file : outputs.data.files())
        check_data_name(file);
    if (std::ranges::count(outputs.files, STDOUT) > 1)
        throw Error("-o: standard output gets one image; give - once", ErrorKind::request);
}

void check_outputs(const ImageOutputs& outputs) {
    check_formats(outputs);
    for (const auto& [option, path] : outputs.outputs()) {
        if (path != STDOUT) check_writable(path);
    }
}

double write_images(const ImageOutputs& given, Image image) {
    const ImageOutputs outputs = given.exposed_for(image);
    if (outputs.half) use_half(image);
    Attempts attempts;
    double encoding = 0.0;
    for (const std::string& path : outputs.files)
        attempts.attempt([&] { encoding += write_image(outputs, path, image, write_finished_work); });
    for (const DataFile& file : outputs.data.files())
        attempts.attempt([&] { outputs.data.write(file, image, outputs.screen.notes(image)); });
    attempts.finish();
    return encoding;
}

void write_current_images(const ImageOutputs& given, const RenderRecord& record, Image image) {
    const ImageOutputs outputs = given.exposed_for(image);
    add_attributes(image, record);
    outputs.denoise(image);
    if (outputs.half) use_half(image);
    for (const std::string& path : outputs.files) {
        if (path == STDOUT) continue;  // Gets the finished image alone.
        try {
            write_image(outputs, path, image, write_file_atomically);
        } catch (const Error& error) {
            print_warning(std::string(error.what()) + "; rendering continues without this image");
        }
    }
}

double write_images(const ImageOutputs& outputs, const RenderRecord& record, Image image) {
    add_attributes(image, record);
    return write_images(outputs, std::move(image));
}

}  // namespace candela
