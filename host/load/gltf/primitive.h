// Primitives of a glTF mesh: triangles, as they are after morphing and skinning.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// What bends a primitive.
struct Deformation {
    std::span<const double> weights{};     // Of its morph targets.
    std::span<const glm::dmat4> joints{};  // Of its skin, to the scene's space; empty: none.
    bool mirrors = false;                  // Whether they turn the triangles round.
};

// Reads a primitive: in its own space, or the scene's if it has a skin. Texture coordinates get v upwards.
// Nothing, with a warning, for one that shows no surface: of points or lines, or without area. Throws Error
// for what cannot be read.
std::optional<TriangleMesh> read_primitive(File& file, const Node& primitive, const Deformation& deformation);

}  // namespace candela::gltf
