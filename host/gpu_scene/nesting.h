// Finds solids with media that may lie within each other, and warns of oddities.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace candela {

struct Nesting {
    // Whether paths must track the media they are in: the boxes around two solids overlap, or rays may miss a
    // side of a solid.
    bool nested = false;
    // Whether some solids scatter light, and it comes into them through their surfaces alone, which no shadow
    // ray does; none of the lights that have a place lies within. In doubt false.
    bool sealed = false;
    // About open meshes that enclose a medium, solids nested deeper than a path can track (MEDIA_AT_ONCE),
    // and solids that are too thin.
    std::vector<std::string> warnings;
};

// Quads and disks that enclose the same medium are one solid; each closed part of a mesh is a solid of its
// own.
Nesting find_nesting(const Scene& scene);

// The name of scene.shapes[i] in messages.
std::string name_of_shape(const Scene& scene, size_t i);

}  // namespace candela
