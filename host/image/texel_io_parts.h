// Shared by the files texel_io*.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "image/texel_image.h"
#include "image/texel_io.h"

namespace candela {

// A file to be decoded, and where its warnings go.
struct TexelSource {
    std::string_view bytes;
    const std::filesystem::path& name;
    const TexelLimits& limits;
    std::vector<std::string>& warnings;

    [[noreturn]] void fail(const std::string& reason) const;
    [[noreturn]] void fail_damaged(const std::string& how) const;
    // Throws the Error of a file with too few bytes for its picture, regardless of their values.
    [[noreturn]] void fail_too_short(uvec2 size) const;
    void warn(const std::string& what) const;
};

// An image of that size, all zeros. Throws std::bad_alloc.
TexelImage make_texels(uvec2 size, uint32_t channels, TexelType type);

// One function per format. Each is given a file that begins as the format does, and throws Error, or
// std::bad_alloc.
TexelImage decode_png_texels(const TexelSource& source);
TexelImage decode_jpeg_texels(const TexelSource& source);
TexelImage decode_webp_texels(const TexelSource& source);
TexelImage decode_ktx_texels(const TexelSource& source);
TexelImage decode_hdr_texels(const TexelSource& source);
TexelImage decode_exr_texels(const TexelSource& source);
TexelImage decode_bmp_texels(const TexelSource& source);
TexelImage decode_targa_texels(const TexelSource& source);

// Whether a file begins as Targa files do, which have no signature.
bool is_targa(std::string_view bytes);

}  // namespace candela
