// Changes of the triangles of a scene's meshes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "load/node.h"
#include "scene/scene.h"
#include "scene/scene_change.h"

namespace candela {

// A mesh of the scene, and what is to take its place.
struct ChangedMesh {
    uint32_t mesh = 0;  // Index into Scene::meshes.
    TriangleMesh now;
};

// Reads the meshes that a change names: by the name of the object that shows one, each with the keys of a
// mesh in scene files but those of its shape. Arrays are those of `change`, which gets the warnings. Throws
// Error at the mesh's place for an object that is not exactly one mesh, and for what is also an error in a
// scene file.
std::vector<ChangedMesh> read_mesh_changes(const Node& meshes, const Scene& scene, Scene& change);

// Gives them to the scene, and notes what has changed.
void take_meshes(std::vector<ChangedMesh> meshes, Scene& scene, SceneChange& change);

// Gives `to` the mesh that `from` has for the object of that name, if both have one.
void carry_mesh(std::string_view object, const Scene& from, Scene& to);

}  // namespace candela
