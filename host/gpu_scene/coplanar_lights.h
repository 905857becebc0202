// Lights that lie in the plane of another surface.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace candela {

// The warning about quads, disks and triangles that emit and overlap another shape in one plane, where
// rounding decides which of the two rays hit; nothing if there are none among the first hundred that emit.
std::optional<std::string> warn_of_coplanar_lights(const Scene& scene);

}  // namespace candela
