// Which solids that enclose media may lie within each other, and what is odd about them.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace candela {

struct Nesting {
    bool nested = false;  // The boxes around two solids overlap.
    // Meshes with holes whose inside counts, and more solids within each other than paths can keep in mind.
    std::vector<std::string> warnings;
};

// Quads and disks that enclose the same medium count as one solid.
Nesting find_nesting(const Scene& scene);

}  // namespace candela
