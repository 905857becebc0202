// The solids that a mesh encloses: its connected parts.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candela {

// Connected triangles. Volumes are positive inside surfaces whose front is outside, and negative around a
// cavity; the volume of a part that is not closed is meaningless.
struct MeshSolid {
    Box box;              // In the mesh's space, relative to its origin.
    double volume = 0.0;  // There.
    bool closed = false;  // Each edge of each triangle is also an edge of another, in the opposite direction.
    std::vector<uint32_t> triangles;  // Their indices.
};

// The parts of a mesh. Vertices at the same place are treated as one, and so are vertices at most four steps
// of the greatest coordinate's floats apart, as at a seam with rounding.
std::vector<MeshSolid> find_mesh_solids(const TriangleMesh& mesh);

}  // namespace candela
