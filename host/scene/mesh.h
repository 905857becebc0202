// What every mesh goes through between a file and the scene.
#pragma once

#include <cstddef>
#include <span>

#include "scene/scene.h"

namespace candela {

// Where the shading normals of a mesh from a file come from.
enum class MeshNormals {
    file,    // As the file says, flat where it says nothing.
    smooth,  // Averages, as smooth_normals() says.
    flat,
};

// Removes the triangles whose corners lie on a line or point. Returns how many there were.
size_t drop_flat_triangles(TriangleMesh& mesh);

// Replaces the normals by unit averages of those of the triangles around each position, weighted by the angle
// there. Vertices at equal positions share one normal. It is zero where the triangles cancel each other.
// Ref: Thuermer, Wuethrich, "Computing Vertex Normals from Polygonal Facets" (1998).
void smooth_normals(TriangleMesh& mesh);

// Gives each corner without a normal (a normal of length zero) that of its triangle, in a vertex of its own;
// removes the normals if no vertex has one. No triangle may be flat.
void complete_normals(TriangleMesh& mesh);

// Cuts a mesh into `count` parts: triangle i goes to part part_of[i]. Each part has the vertices that it
// uses.
std::vector<TriangleMesh> split_mesh(const TriangleMesh& mesh, std::span<const uint32_t> part_of,
                                     size_t count);

}  // namespace candela
