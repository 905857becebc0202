// Which solids that enclose media may lie within each other, and what is odd about them.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace candela {

struct Nesting {
    // Whether paths must keep in mind which media they are in: the boxes around two solids overlap, or rays
    // may miss a side of a solid.
    bool nested = false;
    // Meshes with holes whose inside counts, more solids within each other than paths can keep in mind, and
    // solids that are too thin.
    std::vector<std::string> warnings;
};

// Quads and disks that enclose the same medium count as one solid; the closed parts of a mesh, as several.
Nesting find_nesting(const Scene& scene);

// What messages call scene.shapes[i].
std::string name_of_shape(const Scene& scene, size_t i);

}  // namespace candela
