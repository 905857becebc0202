// Formats, PNG files, and what the readers share. No other file includes stb_image_write.
#include "image/image_io.h"

#include <cassert>
#include <string>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include "base/error.h"
#include "base/file.h"
#include "image/image_io_parts.h"

namespace candela {
namespace fs = std::filesystem;

void check_pixel_count(const fs::path& path, uint64_t width, uint64_t height, uint64_t max_pixels) {
    if (width * height <= max_pixels) return;
    throw Error("cannot read " + quoted(path) + ": its " + std::to_string(width) + 'x' +
                std::to_string(height) + " pixels are more than the " + std::to_string(max_pixels) +
                " allowed here; make the image smaller");
}

ImageFormat image_format(const fs::path& path) {
    const std::string extension = extension_of(path);
    if (extension == ".exr") return ImageFormat::exr;
    if (extension == ".png") return ImageFormat::png;
    throw Error("image file " + quoted(path) + " has " +
                    (extension.empty() ? "no extension" : "the unknown extension \"" + extension + '"') +
                    " (supported: .exr, .png)",
                ErrorKind::request);
}

Image decode_image(std::string_view bytes, const fs::path& name, const ImageLimits& limits) {
    if (bytes.starts_with(EXR_MAGIC)) return decode_exr(bytes, name, limits);
    if (bytes.starts_with(HDR_MAGIC)) return decode_hdr(bytes, name, limits);
    throw Error("cannot read " + quoted(name) +
                ": it is neither an OpenEXR image nor a Radiance picture; give an .exr or .hdr image");
}

void write_png(const fs::path& path, uint32_t width, uint32_t height, std::span<const uint8_t> rgb8,
               FileWriter write) {
    assert(rgb8.size() == size_t(3) * width * height);
    constexpr uint64_t MAX_BYTES = uint64_t(1) << 30;  // stb_image_write counts bytes in an int, twice over.
    if ((uint64_t(3) * width + 1) * height > MAX_BYTES) {
        throw Error("cannot write " + quoted(path) + ": " + std::to_string(width) + 'x' +
                    std::to_string(height) + " pixels are too many for the PNG encoder; write an EXR file");
    }
    std::string bytes;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), size_t(size));
    };
    if (stbi_write_png_to_func(append, &bytes, int(width), int(height), 3, rgb8.data(), 0) == 0) {
        throw Error("cannot write " + quoted(path) + ": there is not enough memory to encode the PNG file");
    }
    write(path, bytes);
}

}  // namespace candela
