// Shared by the files image_io*.cpp; some of it also by texel_io*.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "image/image.h"
#include "image/image_io.h"

namespace candela {

// The first bytes of OpenEXR files and of Radiance pictures.
inline constexpr std::string_view EXR_MAGIC("\x76\x2f\x31\x01"), HDR_MAGIC("#?");

// The most pixels along either side of an image that is read; a larger number means a damaged header.
inline constexpr uint32_t MAX_IMAGE_SIDE = 1 << 20;

// Throws Error if width * height exceeds `max_pixels`; both sides are at most MAX_IMAGE_SIDE.
void check_pixel_count(const std::filesystem::path& path, uint64_t width, uint64_t height,
                       uint64_t max_pixels);

// The bytes of write_picture()'s files; messages call them `path`.
std::string encode_png(const std::filesystem::path& path, const TexelImage& picture,
                       const PictureNotes& notes);
std::string encode_jpeg(const std::filesystem::path& path, const TexelImage& picture, int quality);
std::string encode_webp(const std::filesystem::path& path, const TexelImage& picture, int quality);

// Throws Error if a side of the picture exceeds `max` pixels.
void check_sides(const std::filesystem::path& path, const TexelImage& picture, uint32_t max,
                 const char* format);

// Grows the wanted channels to that many rows, so that a short file with a header for a huge picture ends
// before memory runs out.
void grow(Image& image, uint32_t rows, const ImageLimits& limits);

// Decodes an OpenEXR file of one part into the image's channels through the library's C++ interface, which
// trusts the header. Throws a std::exception if pixels are damaged.
void decode_exr_by_rows(std::string_view file, Image& image, const ImageLimits& limits);

}  // namespace candela
