// Changes of where a scene's objects are, and whether they are seen.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "load/node.h"
#include "scene/scene.h"
#include "scene/scene_change.h"

namespace candela {

// What is said of an instance of an object.
struct InstanceEdit {
    std::optional<Transform> transform{};  // Places it, in place of its transform.
    std::optional<bool> visible{};

    bool operator==(const InstanceEdit&) const = default;
};

// By the name of the object, and the number of the instance among its own.
using InstanceEdits = std::map<std::pair<std::string, uint32_t>, InstanceEdit>;

// Reads the objects that a change names: each an object with "transform", if it is shown once, or "visible";
// or with "instances", which has those of instances by their numbers. Throws Error at its place for what the
// scene does not have.
InstanceEdits read_object_changes(const Node& objects, const Scene& scene);

// Adds what is said later.
void add(InstanceEdits& edits, const InstanceEdits& later);

// A shape as an edit has it: its geometry, origin and visibility.
struct MovedShape {
    uint32_t shape = 0;  // Index into Scene::shapes.
    Shape moved;
};

// The shapes of these instances; those that the scene does not have are ignored. The scene may get a mesh
// without triangles, for what is not seen. Throws Error, beginning with `name`, if an object cannot be placed
// so.
std::vector<MovedShape> move_shapes(const InstanceEdits& edits, const std::string& name, Scene& scene);

// Gives them to the scene, and notes what has changed.
void take_shapes(std::vector<MovedShape> shapes, Scene& scene, SceneChange& change);

}  // namespace candela
