// What the files image_io*.cpp share.
#pragma once

#include <cstdint>
#include <filesystem>

namespace candela {

// Pixels along either side of an image that is read; more can only be a damaged header.
inline constexpr uint32_t MAX_IMAGE_SIDE = 1 << 20;

// Throws Error if width * height exceeds `max_pixels`; both sides are at most MAX_IMAGE_SIDE.
void check_pixel_count(const std::filesystem::path& path, uint64_t width, uint64_t height,
                       uint64_t max_pixels);

}  // namespace candela
