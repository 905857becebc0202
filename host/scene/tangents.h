// Tangents of meshes, for normal maps.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace candela {

// Gives each vertex of a mesh the tangent that MikkTSpace, by which most programs bake normal maps, gives to
// its corners. Corners of one vertex that differ in their tangents get vertices of their own, after the
// others; a tangent is unit and orthogonal to its normal.
//
// `uv_set` says by which texture coordinates: 0 for uv0, 1 for uv1, which the mesh must have. v grows
// upwards; where it grows downwards, w has the wrong sign. The mesh's own tangents are replaced. A corner
// without a normal takes that of its triangle, which the mesh does not keep.
//
// Triangles whose texture coordinates span no area (less than 6e-39) tell nothing, and take over what
// their neighbours have; so do triangles two of whose corners coincide. A corner without such a neighbour
// gets a direction near +X and w = -1. Which neighbour it is may depend on the triangles' order, and so may
// the result where more than two triangles share an edge; nothing else does.
//
// Takes expected linear time, and about 150 bytes per triangle.
// Ref: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008), equations 18 and 19, and his public
// implementation, http://www.mikktspace.com, for what the thesis leaves open.
void add_tangents(TriangleMesh& mesh, uint32_t uv_set = 0);

}  // namespace candela
