// Where a node places its mesh.
#pragma once

#include <optional>

#include "scene/transform.h"

namespace candela::gltf {

// The transform of a mesh that a node's matrix places. Nothing for one under which a mesh shows no surface.
std::optional<Transform> transform_of(const glm::dmat4& world);

}  // namespace candela::gltf
