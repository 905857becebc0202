// Textures of a glTF file.
#pragma once

#include <cstdint>
#include <optional>

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// The texture that a material's `info` (textureInfo) refers to, with its sampler and transform. Its image is
// added to scene.images. A single number comes from `channel`. Nothing, with a warning, for an image that
// cannot be read because it only exists in a format of an extension.
std::optional<Texture> read_texture(File& file, Scene& scene, const Node& info, TextureEncoding encoding,
                                    uint32_t channel = RED);

// The index into scene.images of an element of the file's images.
uint32_t read_image(File& file, Scene& scene, const Node& reference);

}  // namespace candela::gltf
