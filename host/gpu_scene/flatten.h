// Shapes -> primitives: the scene in its own order, before the BVH reorders it.
#pragma once

#include <array>
#include <vector>

#include "gpu_scene/instancing.h"
#include "scene/frame.h"
#include "scene/scene.h"
#include "shared/primitive.h"
#include "shared/texture.h"

namespace candela {

// Texture coordinates over a piece of a surface: origin + b1 along_b1 + b2 along_b2, at the surface
// coordinates of its light.
struct PieceUv {
    vec2 origin{0};
    vec2 along_b1{0};
    vec2 along_b2{0};
};

// A piece of a surface that emits: a light, unless it is black (light_arrays.h).
struct EmittingPiece {
    uint32_t primitive = 0;  // Its first one,
    uint32_t shape = 0;      // and the shape to which it belongs.
    uint32_t kind = 0;       // LIGHT_*
    double error = 0.0;      // How far from it rays must begin; see ray_error.h.
    PieceUv uv;
};

// Where the ids of surfaces of a shape, and of one group of its mesh, begin, which end where the next begin.
struct ShapeIds {
    uint32_t first = 0;
    uint32_t shape = 0;
    uint32_t group = 0;  // As TriangleMesh::groups.
};

struct FlatScene {
    std::vector<Primitive> primitives;
    // One per primitive; `light` is the index of a piece, or NO_LIGHT.
    std::vector<Surface> surfaces;
    std::vector<std::array<uvec4, NORMALS_WORDS>> normals;  // One per primitive, or none if all are flat.
    std::vector<uvec4> attributes;                          // attribute_words() per primitive.
    uint64_t triangles = 0;                                 // Of meshes; and of these,
    uint64_t coarse = 0;                                    // as count_coarse_triangles() says.
    uint64_t flattened = 0;           // Triangles that are left out: rounded to floats, they have no area.
    uint64_t spheres = 0;             // And of these,
    uint64_t coarse_spheres = 0;      // those that rounding moves by more than 3 % of their radius.
    uint32_t id_count = 0;            // Ids that the surfaces have: one for each triangle, sphere and disk.
    std::vector<ShapeIds> shape_ids;  // Of all shapes, ascending.
    std::vector<EmittingPiece> pieces;
};

// The records are in `frame`. `attributes` (bits ATTRIBUTE_*) says which of the
// vertices' attributes are kept; `left_out`, unless empty, which shapes are left out.
FlatScene flatten(const Scene& scene, const SceneFrame& frame, uint attributes = 0,
                  const std::vector<bool>& left_out = {});

// A mesh by itself, of material 0; with records of normals if has_normals, zeros where it has none. It emits
// like the shape `emitter`, unless that is NO_EMITTER.
FlatScene flatten_mesh(const Scene& scene, const ShownMesh& shown, bool passable, const SceneFrame& frame,
                       uint attributes, bool has_normals);

// For each id of the triangles of a mesh, in order, the vertices a, b, c of its surface coordinates: these
// say a + x (b - a) + y (c - a). The mesh is placed and emits as flatten() or flatten_mesh() was told.
std::vector<uvec3> corners_by_id(const TriangleMesh& mesh, const Transform& transform,
                                 const SceneFrame& frame, bool emits);

// Whether a mesh that is shown has shading normals.
bool has_shading_normals(const Scene& scene);

// The least box around a primitive, and around each of several.
Box bounds(const Primitive& primitive);
std::vector<Box> boxes_of(const std::vector<Primitive>& primitives);

}  // namespace candela
