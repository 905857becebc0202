// Animations of a glTF file, which pose nodes at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "load/gltf/pose.h"

namespace candela::gltf {

// Poses the nodes at `time` [s]: by the animation of that name or index, by all animations ("all"), or, if no
// name is given, by the first. An animation is constant before its first key and after its last one. Throws
// Error (usage) for an animation that the file lacks.
void animate(File& file, const std::optional<std::string>& name, double time, std::vector<PosedNode>& nodes);

}  // namespace candela::gltf
