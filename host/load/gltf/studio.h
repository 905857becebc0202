// The studio that lights a glTF file without light of its own; add_studio() of gltf.h decides which file.
#pragma once

#include "scene/scene.h"

namespace candela::gltf {

// A large soft light above and to the left, a weaker one to the right, a strip behind, a pale floor and dim
// walls. White paper in it has a radiance of up to 0.95. No camera ray sees it.
Environment studio();

}  // namespace candela::gltf
