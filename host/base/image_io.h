// Image files: OpenEXR in and out, PNG out. The only interface to the libraries that do it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "base/image.h"

namespace candela {

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
void write_exr(const std::filesystem::path& path, const Image& image);

// Reads all channels of the first part of an OpenEXR file, of any type, as 32-bit floats (`half` remembers
// 16-bit ones), and the attributes that an Image can hold; matrices are turned back into glm's convention.
// The result is placed relative to the display window. Throws Error if the file is missing, no OpenEXR file,
// damaged or incomplete, or uses what an Image cannot hold: overscan or subsampled channels.
Image read_exr(const std::filesystem::path& path);

// Writes 8-bit RGB, row-major from the top, 3 * width * height bytes, without loss. Throws Error if the file
// cannot be written or the picture is larger than the encoder's limit of 2^30 bytes. The file appears whole
// or not at all.
void write_png(const std::filesystem::path& path, uint32_t width, uint32_t height,
               std::span<const uint8_t> rgb8);

}  // namespace candela
