// Skins of a glTF file: vertices that follow several nodes.
#pragma once

#include <vector>

#include "load/gltf/pose.h"

namespace candela::gltf {

// For each joint of a skin, the transform from the space of the mesh to that of the scene.
std::vector<glm::dmat4> joint_matrices(File& file, const Node& skin, const std::vector<PosedNode>& nodes);

}  // namespace candela::gltf
