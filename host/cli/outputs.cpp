// Writes images with their attributes.
#include "cli/outputs.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "base/file.h"
#include "cli/attempts.h"
#include "cli/console.h"
#include "image/image_io.h"
#include "image/tonemap.h"

namespace candela {
namespace {

// Marks R G B A and Albedo as 16-bit. A channel whose values exceed 16 bits keeps 32, with a warning: no
// sample may be lost.
void use_half(Image& image) {
    constexpr float LARGEST_HALF = 65504.0f;
    constexpr std::string_view COLOUR_CHANNELS[] = {"R", "G", "B", "A", "Albedo.R", "Albedo.G", "Albedo.B"};
    for (Channel& channel : image.channels) {
        if (std::ranges::find(COLOUR_CHANNELS, channel.name) == std::end(COLOUR_CHANNELS)) continue;
        channel.half = std::ranges::all_of(
            channel.values, [](float v) { return !std::isfinite(v) || std::abs(v) <= LARGEST_HALF; });
        if (!channel.half) {
            print_warning("channel " + channel.name +
                          " holds values beyond 65504, the largest 16-bit float; it is written with 32 bits");
        }
    }
}

void write_image(const ImageOutputs& outputs, const std::string& path, const Image& image, FileWriter write) {
    if (image_format(path) == ImageFormat::exr) {
        write_exr(path, image, write);
    } else {
        write_png(path, image.data.width(), image.data.height(),
                  develop(image, outputs.development.tonemap, float(outputs.development.exposure)), write);
    }
}

}  // namespace

void check_formats(const std::vector<std::string>& files) {
    if (files.empty()) {
        throw Error("no output given; use -o FILE.exr, -o FILE.png, or both", ErrorKind::request);
    }
    for (const std::string& path : files)
        image_format(path);
}

void check_outputs(const std::vector<std::string>& files) {
    check_formats(files);
    for (const std::string& path : files)
        check_writable(path);
}

void write_images(const ImageOutputs& outputs, Image image) {
    if (outputs.half) use_half(image);
    Attempts attempts;
    for (const std::string& path : outputs.files)
        attempts.attempt([&] { write_image(outputs, path, image, write_finished_work); });
    attempts.finish();
}

void write_current_images(const ImageOutputs& outputs, const RenderRecord& record, Image image) {
    add_attributes(image, record);
    if (outputs.half) use_half(image);
    for (const std::string& path : outputs.files) {
        try {
            write_image(outputs, path, image, write_file_atomically);
        } catch (const Error& error) {
            print_warning(std::string(error.what()) + "; rendering continues without this image");
        }
    }
}

void write_images(const ImageOutputs& outputs, const RenderRecord& record, Image image) {
    add_attributes(image, record);
    write_images(outputs, std::move(image));
}

}  // namespace candela
