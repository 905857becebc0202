// Tangents of meshes, for normal maps.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace candela {

// Gives each vertex of a mesh the tangent that MikkTSpace, by which most programs bake normal maps, gives to
// its corners. Corners of one vertex that differ in their tangents get vertices of their own, after the
// others; a tangent is unit and orthogonal to its normal.
//
// `uv_set` selects the texture coordinates, which the mesh must have: 0 for uv0, 1 for uv1. v grows upwards;
// where it grows downwards, w has the wrong sign. The mesh's own tangents are replaced. A corner without a
// normal uses its triangle's, which is not kept in the mesh.
//
// Triangles whose texture coordinates span no area (less than 6e-39) have no tangent of their own, and use
// their neighbours'; so do triangles with two coincident corners. A corner without such a neighbour gets a
// direction near +X and w = -1. The choice of the neighbour may depend on the triangles' order, and so may
// the result where more than two triangles share an edge; nothing else does.
//
// Takes expected linear time, and about 150 bytes per triangle.
// Ref: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008), equations 18 and 19, and his public
// implementation, http://www.mikktspace.com, for what the thesis leaves open.
void add_tangents(TriangleMesh& mesh, uint32_t uv_set = 0);

}  // namespace candela
