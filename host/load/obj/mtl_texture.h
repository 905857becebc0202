// The statements of MTL files that name textures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/texture.h"

namespace candela {

// What follows a command such as map_Kd: options, and the name of a file.
struct MtlTexture {
    std::string file;   // Relative to the folder of the MTL file, with slashes; empty if none is named.
    std::string place;  // Place of the statement, as `file:line`.
    Texture texture{};  // How it is looked up; image, encoding and channel are set later.
    std::optional<uint32_t> channel;   // -imfchan: 0 .. 3.
    float multiplier = 1.0f;           // -bm, the factor of normals and heights; within +-1000.
    std::vector<std::string> ignored;  // Ignored options that would change the picture.
};

// Reads the rest of a statement:
//   -s u [v [w]], -o u [v [w]]  the image is looked up at s * (u, v) + o; each within +-1e6;
//   -clamp on|off               what lies beyond the image: its edge, or the image again;
//   -imfchan r|g|b|m|l|z        which channel is a number; m is alpha, l is read as r, z is ignored;
//   -bm x                       the multiplier;
//   -mm, -t, -boost, -texres, -type, -blendu, -blendv, -cc   ignored.
// An unknown option is ignored, with the numbers that follow it. The file's name is all text before, between
// or after the options, including spaces; backslashes become slashes. Throws Error `place: cause` for a value
// that is malformed or out of range.
// Ref: Alias|Wavefront, "MTL material format" (1995).
MtlTexture parse_mtl_texture(std::string_view command, std::string_view rest, const std::string& place);

}  // namespace candela
