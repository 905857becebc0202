// Image files: OpenEXR in and out, Radiance HDR in; PNG, JPEG and WebP out. The only interface to the
// libraries for them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"
#include "image/image.h"
#include "image/texel_image.h"

namespace candela {

// Formats of images that are written.
enum class ImageFormat { exr, png, jpeg, webp };

// The format that the extension of `path` names, in upper or lower case. Throws Error (request) for
// any other.
ImageFormat image_format(const std::filesystem::path& path);

// Writes an OpenEXR file of one part: scan lines, ZIP compression, the channels in the order of their names,
// each 32-bit or 16-bit float by its flag, Rec.709 chromaticities, and the image's attributes. The display
// window is the whole picture, the data window image.data. Attribute matrices are given as glm's, for column
// vectors; the file holds their transposes, for row vectors, as OpenEXR defines. Throws Error if the file
// cannot be written, or if a finite value of a 16-bit channel exceeds 65504. The file appears whole or not at
// all.
void write_exr(const std::filesystem::path& path, const Image& image,
               FileWriter write = write_file_atomically);

// What to read from an image.
struct ImageLimits {
    // An image with more is refused before any of them is read.
    uint64_t max_pixels = uint64_t{1} << 30;
    // The channels whose values are read; all if none is named. The others get no values.
    std::vector<std::string_view> channels{};

    bool wants(std::string_view channel) const {
        return channels.empty() || std::ranges::find(channels, channel) != channels.end();
    }
};

// Reads the first part of an OpenEXR file, scan lines or tiles, of any type, as 32-bit floats (`half`
// remembers 16-bit ones), and the attributes that an Image can hold; matrices are turned back into glm's
// convention. The result is placed relative to the display window. Throws Error if the file is missing, not
// an OpenEXR file, damaged or incomplete, uses what an Image cannot hold (overscan, subsampled channels, deep
// pixels), or exceeds the limits. Memory is bounded by what the file's bytes can expand to.
Image read_exr(const std::filesystem::path& path, const ImageLimits& limits = {});

// The same without any values; the rest of the file is not read.
Image read_exr_header(const std::filesystem::path& path);

// read_exr() for the bytes of a file; messages call it `name`.
Image decode_exr(std::string_view bytes, const std::filesystem::path& name, const ImageLimits& limits = {});

// Reads a Radiance picture, flat or in either of the format's run-length encodings, as the channels R, G and
// B. Mantissas m and exponent e give exactly m 2^(e - 136), divided by the factors in the header's lines
// EXPOSURE and COLORCORR. The line PRIMARIES is ignored. Throws Error if the file is missing, not a Radiance
// picture, damaged or incomplete, has XYZ colours, or exceeds the limits.
// Ref: Ward, "Real Pixels", Graphics Gems II (1991); "Radiance File Formats" (1994), "Picture File Format".
Image read_hdr(const std::filesystem::path& path, const ImageLimits& limits = {});

// read_hdr() for the bytes of a file; messages call it `name`.
Image decode_hdr(std::string_view bytes, const std::filesystem::path& name, const ImageLimits& limits = {});

// decode_exr() or decode_hdr(), by the first bytes. Throws Error as these do, and for any other file.
Image decode_image(std::string_view bytes, const std::filesystem::path& name, const ImageLimits& limits = {});

// What a file of a picture for the screen states besides its pixels.
struct PictureNotes {
    // PNG: names, of 1 to 79 characters, and texts, in UTF-8.
    std::vector<std::pair<std::string, std::string>> texts{};
    int quality = 90;  // JPEG, WebP: 1 to 100.
};

// Writes a picture in sRGB with 3 channels, or 4 with straight alpha, or a PNG of one
// channel of numbers that are not light, in the format that the extension names:
// PNG of 8 or 16 bits, without loss; JPEG of 8 bits, without alpha, at full resolution of colours; WebP of 8
// bits, with loss, but not of alpha. Throws Error if the file cannot be written, or the format cannot hold
// the picture. The file appears whole or not at all.
void write_picture(const std::filesystem::path& path, const TexelImage& picture,
                   const PictureNotes& notes = {}, FileWriter write = write_file_atomically);

// write_picture() of 8-bit RGB, row-major from the top, 3 * width * height bytes.
void write_png(const std::filesystem::path& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgb8, FileWriter write = write_file_atomically);

}  // namespace candela
