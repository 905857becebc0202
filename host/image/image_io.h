// Image files: OpenEXR in and out, Radiance HDR in, PNG out. The only interface to the libraries that do it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "image/image.h"

namespace candela {

// Formats of images that are written.
enum class ImageFormat { exr, png };

// The format that the extension of `path` names, whatever its case. Throws Error (exit code usage) for any
// other.
ImageFormat image_format(const std::filesystem::path& path);

// Writes an OpenEXR file of one part: scan lines, ZIP compression, the channels in the order of their names,
// each 32-bit or 16-bit float by its flag, Rec.709 chromaticities, and the image's attributes. The display
// window is the whole picture, the data window image.data. Attribute matrices are handed in as glm's, for
// column vectors; the file holds the transposed matrices that OpenEXR defines, for row vectors. Throws Error
// if the file cannot be written, or if a finite value of a 16-bit channel exceeds 65504. The file appears
// whole or not at all.
void write_exr(const std::filesystem::path& path, const Image& image,
               FileWriter write = write_file_atomically);

// What to read of an image.
struct ImageLimits {
    // An image with more is refused before any of them is read.
    uint64_t max_pixels = uint64_t{1} << 30;
    // The channels whose values are read; all if none is named. The others have no values.
    std::vector<std::string_view> channels{};

    bool wants(std::string_view channel) const {
        return channels.empty() || std::ranges::find(channels, channel) != channels.end();
    }
};

// Reads the first part of an OpenEXR file, scan lines or tiles, of any type, as 32-bit floats (`half`
// remembers 16-bit ones), and the attributes that an Image can hold; matrices are turned back into glm's
// convention. The result is placed relative to the display window. Throws Error if the file is missing, no
// OpenEXR file, damaged or incomplete, uses what an Image cannot hold (overscan, subsampled channels, deep
// pixels), or exceeds the limits. Takes no more memory than the file's bytes may stand for.
Image read_exr(const std::filesystem::path& path, const ImageLimits& limits = {});

// The same without any values; what else the file holds is not read.
Image read_exr_header(const std::filesystem::path& path);

// read_exr() for the bytes of a file; `name` is what messages call it.
Image decode_exr(std::string_view bytes, const std::filesystem::path& name, const ImageLimits& limits = {});

// Reads a Radiance picture, flat or in either of the format's run-length encodings, as the channels R, G and
// B. Mantissas m and exponent e stand for m 2^(e - 136) exactly, divided by what the header's lines EXPOSURE
// and COLORCORR say the file was multiplied by. Colours are taken as they are, whatever the line PRIMARIES
// says. Throws Error if the file is missing, no Radiance picture, damaged or incomplete, has XYZ colours, or
// exceeds the limits.
// Ref: Ward, "Real Pixels", Graphics Gems II (1991); "Radiance File Formats" (1994), "Picture File Format".
Image read_hdr(const std::filesystem::path& path, const ImageLimits& limits = {});

// read_hdr() for the bytes of a file; `name` is what messages call it.
Image decode_hdr(std::string_view bytes, const std::filesystem::path& name, const ImageLimits& limits = {});

// decode_exr() or decode_hdr(), as the first bytes say. Throws Error as these do, and for any other file.
Image decode_image(std::string_view bytes, const std::filesystem::path& name, const ImageLimits& limits = {});

// Writes 8-bit RGB, row-major from the top, 3 * width * height bytes, without loss. Throws Error if the file
// cannot be written or the picture is larger than the encoder's limit of 2^30 bytes. The file appears whole
// or not at all.
void write_png(const std::filesystem::path& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgb8, FileWriter write = write_file_atomically);

}  // namespace candela
