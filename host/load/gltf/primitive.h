// Primitives of a glTF mesh: triangles, as they are after morphing and skinning.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "load/gltf/gltf_file.h"
#include "scene/scene.h"

namespace candela::gltf {

// What deforms a primitive.
struct Deformation {
    std::span<const double> weights{};     // Weights of its morph targets.
    std::span<const glm::dmat4> joints{};  // Joints of its skin, to the scene's space; empty: none.
    bool mirrors = false;                  // Whether they reverse the winding of triangles.
};

// Reads a primitive: in its own space, or the scene's if it has a skin. Texture coordinates get v upwards.
// Returns nothing, with a warning, for a primitive without a surface: points or lines, or triangles without
// area. Throws Error for what cannot be read.
std::optional<TriangleMesh> read_primitive(File& file, const Node& primitive, const Deformation& deformation);

// The positions of the mesh's first vertices, those that it has before any is added for attributes, of a
// primitive that has been read before. They are the same vertices under any deformation.
std::vector<dvec3> read_positions(File& file, const Node& primitive, const Deformation& deformation);

}  // namespace candela::gltf
