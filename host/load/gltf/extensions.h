// The extensions of glTF files.
#pragma once

#include <string_view>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// Read if reads_ktx_texels().
inline constexpr std::string_view KTX_IMAGES = "KHR_texture_basisu";

// Throws Error if the file requires an extension that is not read; warns of the others that it uses, with
// what will look different.
void check_extensions(File& file);

}  // namespace candela::gltf
