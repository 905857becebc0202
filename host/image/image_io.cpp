// Formats of image files, and what readers and writers share.
#include "image/image_io.h"

#include <cassert>
#include <string>

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
    if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::jpeg;
    if (extension == ".webp") return ImageFormat::webp;
    throw Error("image file " + quoted(path) + " has " +
                    (extension.empty() ? "no extension" : "the unknown extension \"" + extension + '"') +
                    " (supported: .exr, .png, .jpg, .webp)",
                ErrorKind::request);
}

Image decode_image(std::string_view bytes, const fs::path& name, const ImageLimits& limits) {
    if (bytes.starts_with(EXR_MAGIC)) return decode_exr(bytes, name, limits);
    if (bytes.starts_with(HDR_MAGIC)) return decode_hdr(bytes, name, limits);
    throw Error("cannot read " + quoted(name) +
                ": it is neither an OpenEXR image nor a Radiance picture; give an .exr or .hdr image");
}

void check_sides(const fs::path& path, const TexelImage& picture, uint32_t max, const char* format) {
    const uvec2 size = picture.size;
    if (size.x <= max && size.y <= max) return;
    throw Error("cannot write " + quoted(path) + ": a side of its " + std::to_string(size.x) + 'x' +
                std::to_string(size.y) + " pixels is longer than the " + std::to_string(max) + " of a " +
                format + " file; write a PNG or EXR file");
}

void write_picture(const fs::path& path, const TexelImage& picture, const PictureNotes& notes,
                   FileWriter write) {
    assert(picture.texels.size() ==
           size_t{picture.size.x} * picture.size.y * picture.channels * byte_size(picture.type));
    switch (image_format(path)) {
        case ImageFormat::jpeg:
            return write(path, encode_jpeg(path, picture, notes.quality));
        case ImageFormat::webp:
            return write(path, encode_webp(path, picture, notes.quality));
        default:
            return write(path, encode_png(path, picture, notes));
    }
}

void write_png(const fs::path& path, uint32_t width, uint32_t height, std::span<const uint8_t> rgb8,
               FileWriter write) {
    const auto bytes = std::as_bytes(rgb8);
    const TexelImage picture{.size = {width, height},
                             .channels = 3,
                             .type = TexelType::unorm8,
                             .texels = {bytes.begin(), bytes.end()},
                             .gamma = {}};
    write(path, encode_png(path, picture, {}));
}

}  // namespace candela
