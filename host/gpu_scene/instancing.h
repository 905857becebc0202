// Chooses the meshes that get their own trees, and places their instances.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/frame.h"
#include "scene/scene.h"
#include "shared/instance.h"

namespace candela {

// When a mesh gets a tree of its own, below instances; otherwise its copies are baked: each becomes part of
// the scene's one tree. Baked copies are up to 1.3 times as fast while they fit into a CPU's caches, since
// their boxes are tighter and no ray changes its space, and slower beyond a million triangles
// (tests/bench/NOTEBOOK.md).
struct InstancingRule {
    uint32_t min_uses = 2;
    uint64_t min_triangles = 65536;  // Triangles of all copies together.
};

inline constexpr uint32_t NO_EMITTER = ~0u;

// What instances show: a mesh, and how it emits. Instances that emit in another way, or have another material
// and emit, show another one, since lights depend on both; the two share nothing.
struct ShownMesh {
    uint32_t mesh = 0;              // Its index.
    uint32_t emitter = NO_EMITTER;  // The first shape that emits like them, if they do.

    bool operator==(const ShownMesh&) const = default;
    bool operator<(const ShownMesh& other) const {
        return mesh != other.mesh ? mesh < other.mesh : emitter < other.emitter;
    }
};

// The shapes that are instances.
struct Instancing {
    std::vector<uint32_t> shapes;   // Indices, ascending,
    std::vector<ShownMesh> shown;   // and what each of them shows;
    std::vector<ShownMesh> meshes;  // the same once, ascending.
    std::vector<bool> is_instance;  // For every shape.
};

// Follows the rule; of a frame of an animation, meshes that move are instances in any case, so that only what
// they lie in is built for each frame. But shapes that are sheared or scaled too unevenly
// (MAX_INSTANCE_CONDITION) are baked, and so are shapes that emit and are sheared or scaled unevenly at all,
// so that areas and angles of their lights are those of the mesh.
Instancing choose_instances(const Scene& scene, const InstancingRule& rule);

// The placement of an instance in the frame of a scene.
struct PlacedInstance {
    Instance record;  // Only to_mesh, centre and error.
    Box box;          // Around everything that rays may hit there.
};

// `boxes` together contain the mesh, in `mesh_frame`.
PlacedInstance place_instance(const Transform& transform, const SceneFrame& frame,
                              const SceneFrame& mesh_frame, std::span<const Box> boxes);

// The map from the frame of the scene, relative to the instance's centre, to the space of its mesh.
glm::dmat3 map_to_mesh(const Instance& instance);

}  // namespace candela
