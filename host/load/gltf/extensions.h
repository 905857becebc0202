// The extensions of glTF files.
#pragma once

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// Throws Error if the file requires an extension that is not read; warns of the others that it uses, with
// what will look different.
void check_extensions(File& file);

}  // namespace candela::gltf
