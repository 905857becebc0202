// What the tests of image files share.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace candela {

// As write_file_atomically(), but without waiting for the disk.
inline void write_quickly(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

// The header of a Radiance picture with rows from the top, each from the left; `lines` end with a line feed.
inline std::string hdr_header(size_t width, size_t height, const std::string& lines = "") {
    return "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
           std::to_string(width) + '\n';
}

// One pixel of a Radiance picture, as it stands in a flat file: mantissas and exponent.
inline std::string rgbe(int r, int g, int b, int e) {
    return {char(r), char(g), char(b), char(e)};
}

}  // namespace candela
