// Materials of a glTF file, with the extensions that say how surfaces look.
#pragma once

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// A material of the file, without its name, with the images of its textures in scene.images.
Material read_material(File& file, Scene& scene, const Node& material);

// Whether it uses the alpha of its colours.
bool alpha_counts(const Node& material);

// The material of primitives without one.
Material default_material();

}  // namespace candela::gltf
