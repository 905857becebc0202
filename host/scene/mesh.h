// The steps of every mesh from a file to the scene, and from the scene to its frame.
#pragma once

#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "scene/frame.h"
#include "scene/scene.h"

namespace candela {

// Where the shading normals of a mesh from a file come from.
enum class MeshNormals {
    file,    // From the file; flat if it has none.
    smooth,  // Averages, by smooth_normals().
    flat,
};

// The arrays of a mesh that have one element per vertex, or are empty.
inline constexpr auto VERTEX_ARRAYS =
    std::tuple(&TriangleMesh::positions, &TriangleMesh::normals, &TriangleMesh::tangents, &TriangleMesh::uv0,
               &TriangleMesh::uv1, &TriangleMesh::colors);

// Appends vertex `index` of `source`, with all its attributes, to `mesh`, which may be the same. Returns its
// index there.
uint32_t append_vertex(TriangleMesh& mesh, const TriangleMesh& source, uint32_t index);

// Gives a mesh its positions [m], which floats can hold, and its origin: the middle of their bounds,
// truncated to a multiple of the least power of two that is greater than the mesh. So a coordinate that is a
// float is kept exactly, any other is off by a small fraction of the mesh's size, even far from 0, and a mesh
// around 0 has its origin there.
void set_positions(TriangleMesh& mesh, std::vector<glm::dvec3> positions);

// Adds the triangles of a polygon with at least 3 corners, given as indices of vertices; see polygon.h.
void add_polygon(TriangleMesh& mesh, std::span<const uint32_t> corners);

// The least box around the positions, relative to the origin.
Box local_bounds(const TriangleMesh& mesh);

// The number of triangles that are smaller than 16 steps of their coordinates as 32-bit floats, which are too
// coarse for their shape.
size_t count_coarse_triangles(const TriangleMesh& mesh);
// Whether a warning is due: more than one in a hundred of `triangles`.
bool is_too_coarse(uint64_t coarse, uint64_t triangles);

// Removes the triangles whose corners lie on a line or point. Returns their number.
size_t drop_flat_triangles(TriangleMesh& mesh);

// Replaces the normals by unit averages of those of the triangles around each position, weighted by their
// angles there. Vertices at equal positions share one normal, which is zero if the average cancels.
// Ref: Thuermer, Wuethrich, "Computing Vertex Normals from Polygonal Facets" (1998).
void smooth_normals(TriangleMesh& mesh);

// Gives each corner without a normal (a normal of length zero) that of its triangle, in a vertex of its own;
// removes the normals if no vertex has one. No triangle may be flat.
void complete_normals(TriangleMesh& mesh);

// Cuts a mesh into `count` parts: triangle i goes to part part_of[i]. Each part has the vertices that it
// uses.
std::vector<TriangleMesh> split_mesh(const TriangleMesh& mesh, std::span<const uint32_t> part_of,
                                     size_t count);

// The mesh in `frame`: its origin is 0, its positions are rounded to floats, its normals and tangents have
// unit length. Triangles that rounding makes flat remain.
TriangleMesh placed(const TriangleMesh& mesh, const Transform& transform, const SceneFrame& frame = {});

}  // namespace candela
