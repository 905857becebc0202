// What a mesh encloses: its connected parts, as solids of their own.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candela {

// Triangles that hang together. Volumes are positive inside of surfaces whose front is outside, and negative
// around a cavity; that of a part that is not closed means nothing.
struct MeshSolid {
    Box box;              // In the mesh's own space, relative to its origin.
    double volume = 0.0;  // There.
    bool closed =
        false;  // Each edge of each triangle is also that of another one, in the opposite direction.
    std::vector<uint32_t> triangles;  // Their indices.
};

// The parts of a mesh. Vertices at the same place are one; so are those that are not more than four steps of
// the floats of its greatest coordinate apart, which is what rounding makes of a seam.
std::vector<MeshSolid> find_mesh_solids(const TriangleMesh& mesh);

}  // namespace candela
