// Cameras of glTF files.
#pragma once

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// The lens and the size of the picture of a camera, which has neither name nor place yet.
Camera read_camera(File& file, const Node& camera);

// Puts the camera where a node with that matrix is. Returns false, and leaves it where it is, if the matrix
// flattens it.
bool place_camera(const Node& node, const glm::dmat4& world, Camera& camera);

}  // namespace candela::gltf
