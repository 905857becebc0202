// The nodes of a glTF file at one moment: their transforms, and the weights of their morph targets.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/math.h"
#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// How far a quaternion's length may be from 1 without a warning; exporters round to few digits.
inline constexpr double ROTATION_TOLERANCE = 1e-2;

// Position, rotation and size, which may be animated.
struct Trs {
    glm::dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    glm::dvec3 scale{1};
};

// Scales, then rotates, then moves.
glm::dmat4 matrix_of(const Trs& trs);

// Makes the last row of a matrix 0, 0, 0, 1. Returns whether it was that before, up to rounding.
bool make_affine(glm::dmat4& matrix);

struct PosedNode {
    Trs trs{};
    std::optional<glm::dmat4> matrix{};  // In place of trs.
    std::vector<double> weights{};       // Weights of morph targets; empty: the mesh's own.
    std::vector<uint32_t> children{};
    // What NodeTrees adds.
    std::optional<uint32_t> parent{};
    bool is_visible = true;  // KHR_node_visibility; once placed, also that of all nodes above.
    glm::dmat4 world{1.0};   // From the node's space to the scene's.
};

// The nodes as they are in the file, without their parents' transforms.
std::vector<PosedNode> read_nodes(File& file);

}  // namespace candela::gltf
