// Lights of glTF files: KHR_lights_punctual, and the studio that lights a file without any.
#pragma once

#include "load/gltf/gltf.h"
#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// The units of the file's numbers: those that are asked for, or its program's.
LightUnits units_of(const File& file, const GltfOptions& options);

// The light that a node of that placement carries; `reference` holds its index.
Light read_light(File& file, const Node& reference, const glm::dmat4& world, LightUnits units);

// A studio: a large soft light above and to the left, a weaker one to the right, a strip behind, a pale floor
// and dim walls. White paper in it has a radiance of up to 0.95. No camera ray sees it.
Environment studio();

}  // namespace candela::gltf
