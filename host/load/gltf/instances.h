// Nodes that show their mesh many times: EXT_mesh_gpu_instancing.
#pragma once

#include <vector>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// From the mesh's space to the node's, one transform for each copy; for a node without the extension, the
// identity. Throws Error if the accessors' counts differ.
std::vector<glm::dmat4> read_instances(File& file, const Node& node);

}  // namespace candela::gltf
