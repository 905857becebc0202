// Shapes -> primitives and lights: the scene in its own order, before the BVH reorders it.
#pragma once

#include <array>
#include <vector>

#include "scene/frame.h"
#include "scene/scene.h"
#include "shared/light.h"
#include "shared/primitive.h"
#include "shared/texture.h"

namespace candela {

// The surface of a light.
struct LightSurface {
    uint32_t primitive = 0;  // Index of its first primitive.
    const Shape* shape = nullptr;
};

struct FlatScene {
    std::vector<Primitive> primitives;
    std::vector<Surface> surfaces;                          // One per primitive.
    std::vector<std::array<uvec4, NORMALS_WORDS>> normals;  // One per primitive, or none if all are flat.
    std::vector<uvec4> attributes;                          // attribute_words() per primitive.
    uint64_t triangles = 0;                                 // Of meshes; and of these,
    uint64_t coarse = 0;                                    // as count_coarse_triangles() says.
    uint64_t flattened = 0;           // Triangles that are left out: rounded to floats, they have no area.
    uint64_t spheres = 0;             // And of these,
    uint64_t coarse_spheres = 0;      // those that rounding moves by more than 3 % of their radius.
    uint32_t id_count = 0;            // Ids that the surfaces have: one for each triangle, sphere and disk.
    std::vector<LightRecord> lights;  // Those that emit; pmf is 0 until group_lights().
    std::vector<double> powers;       // Power of each light over pi, by its luminance [W],
    std::vector<LightSurface> light_surfaces;  // and what it belongs to.
};

// The records are in `frame`; so are areas and powers. `attributes` (bits ATTRIBUTE_*) says which of the
// vertices' attributes are kept; `left_out`, unless empty, which shapes are left out.
FlatScene flatten(const Scene& scene, const SceneFrame& frame, uint attributes = 0,
                  const std::vector<bool>& left_out = {});

// A mesh by itself, of material 0; with records of normals if has_normals, zeros where it has none.
FlatScene flatten_mesh(const Scene& scene, const MeshInstance& instance, bool lets_pass,
                       const SceneFrame& frame, uint attributes, bool has_normals);

// Whether a mesh that is shown has shading normals.
bool has_shading_normals(const Scene& scene);

// Whether some rays may pass the shape: its material, or the colours of its vertices, are not opaque.
bool lets_rays_pass(const Scene& scene, const Shape& shape);

// The least box around a primitive.
Box bounds(const Primitive& primitive);

}  // namespace candela
