// Meshes that instances show -> trees of their own.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "bvh/bvh.h"
#include "gpu_scene/flatten.h"
#include "gpu_scene/instancing.h"
#include "scene/frame.h"
#include "scene/scene.h"

namespace candela {

struct MeshTree {
    bool passable = false;     // Rays may pass it in some instance.
    SceneFrame frame{};        // Of its own space, in which all that follows is.
    FlatScene flat{};          // Its pieces are those of the shape ShownMesh::emitter.
    Bvh bvh{};                 // Its children are sorted; see two_levels.h.
    std::vector<Box> boxes{};  // Which together contain the mesh; none if no ray can meet it.
};

using MeshTrees = std::map<ShownMesh, MeshTree>;

// The trees of the meshes that instances show, with these attributes (bits ATTRIBUTE_*). A tree depends on
// its mesh, on the texture that it emits, on whether rays may pass it, on the attributes and on whether any
// mesh has shading normals, but not on where its instances are. `known` has trees for which all of these are
// as they were, except perhaps whether rays may pass: they are not built again.
MeshTrees build_mesh_trees(const Scene& scene, const Instancing& instancing, uint attributes,
                           MeshTrees&& known = {});

}  // namespace candela
