// EXT_lights_image_based: light from all around, from a cube of images.
#pragma once

#include <optional>

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// The environment of a scene of the file; nothing if it has none. Only the sharpest images are used; the
// smoother ones and the coefficients are for renderers that do not trace rays.
std::optional<Environment> read_image_light(File& file, const Node& scene);

}  // namespace candela::gltf
