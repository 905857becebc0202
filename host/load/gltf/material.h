// Materials of a glTF file, with the extensions that say how surfaces look.
#pragma once

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// A material of the file, without its name, with the images of its textures in scene.images.
Material read_material(File& file, Scene& scene, const Node& material);

// Whether it lets the alpha of its colours count.
bool alpha_counts(const Node& material);

// What primitives without a material are made of.
Material default_material();

}  // namespace candela::gltf
