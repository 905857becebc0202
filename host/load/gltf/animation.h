// Animations of a glTF file: they put nodes where they are at a moment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "load/gltf/pose.h"

namespace candela::gltf {

// Poses the nodes at `time` [s]: by the animation of that name or index, by all of them ("all"), or, if none
// is stated, by the first. Before its first key and after its last one, an animation stands still. Throws
// Error (usage) for an animation that the file lacks.
void animate(File& file, const std::optional<std::string>& name, double time, std::vector<PosedNode>& nodes);

}  // namespace candela::gltf
