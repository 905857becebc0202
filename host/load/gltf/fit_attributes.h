// The attributes of a primitive that its material looks up.
#pragma once

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// Keeps only the attributes that a material looks up, and adds missing ones. `has_alpha`: whether the file's
// material uses alpha.
void fit_attributes(File& file, const Node& primitive, const Material& material, bool has_alpha,
                    TriangleMesh& mesh);

}  // namespace candela::gltf
