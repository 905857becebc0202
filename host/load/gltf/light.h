// Lights of glTF files: KHR_lights_punctual.
#pragma once

#include "load/gltf/gltf.h"
#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// The units of the file's lights: as chosen, or else by the program that wrote the file.
LightUnits units_of(const File& file, const GltfOptions& options);

// The light that a node of that placement carries; `reference` holds its index.
Light read_light(File& file, const Node& reference, const glm::dmat4& world, LightUnits units);

}  // namespace candela::gltf
