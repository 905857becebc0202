// Files of the images that are textures: PNG, JPEG, WebP, KTX 2, Radiance HDR, OpenEXR, BMP and Targa, told
// apart by their first bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "image/texel_image.h"

namespace candela {

struct TexelLimits {
    // An image with more is refused before memory is allocated for them.
    uint64_t max_pixels = uint64_t{1} << 28;
    // Not a limit: the formats that messages advise.
    const char* formats = "PNG, JPEG, WebP, Radiance HDR or OpenEXR";
};

// Reads an image of one of these kinds from the bytes of a file, regardless of its extension; messages call
// it `name`:
//   PNG       of any colour type and depth; 16 bits stay 16, fewer than 8 become 8, colours of a palette
//             become RGB, and transparent colours an alpha channel. For an animation, the default image.
//   JPEG      grey or of three colours, baseline or progressive, of 8 bits.
//   WebP      lossy or lossless, without animation.
//   KTX 2     one image, compressed by Basis Universal as ETC1S or UASTC: its largest level, of 8 bits. Only
//             if reads_ktx_texels().
//   Radiance  as read_hdr(), as halves.
//   OpenEXR   as read_exr(): R, G and B, or Y, each with A or without, as halves. Its colours, premultiplied
//             by convention, are divided by alpha wherever that is above 0.
//   BMP       without compression.
//   Targa with run lengths or without, from left to right. Its alpha is used if the header says so. In
// halves, values above 65504 become 65504; negative and non-finite values become 0. Colour profiles and the
// orientation that a camera notes are ignored. `warnings` gets what is odd but usable, each beginning with
// the name. Throws Error if the file is of another kind, damaged or incomplete, or exceeds the limits. Memory
// is bounded by what the file's bytes can expand to, if the format has such a bound (PNG, Huffman-coded JPEG,
// Radiance, most kinds of OpenEXR, BMP, Targa). Any number of threads may call it.
TexelImage decode_texels(std::string_view bytes, const std::filesystem::path& name,
                         std::vector<std::string>& warnings, const TexelLimits& limits = {});

// Whether this program is built with a decoder for KTX 2 (cmake/basisu.sh).
bool reads_ktx_texels();

}  // namespace candela
