// Changes of a loaded scene, in the syntax of scene files.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "load/json/change_objects.h"
#include "scene/scene.h"
#include "scene/scene_change.h"

namespace candela {

// What of a scene changes have replaced: cameras, materials and the meshes of objects of these names, perhaps
// the environment and the punctual lights, and what is said of objects.
struct SceneEdits {
    std::set<std::string> cameras{}, materials{}, meshes{};
    bool environment = false, lights = false;
    InstanceEdits objects{};
};

// Reads `text`, an object with any of the keys "cameras", "materials", "lights", "environment" and "sky" of a
// scene file, and replaces cameras and materials of the same names, all punctual lights, and the environment;
// a material without a "type" keeps the values that are not given. The keys "objects" and "meshes" are read
// by read_object_changes() and read_mesh_changes(). A camera of a new name joins the others. Shapes without
// an emission of their own emit as their new material does. Files are relative to `folder` and within
// scene.reach; images are read anew, or are among `arrays`. What is replaced joins `edits`. Returns what has
// changed of the scene, besides cameras.
//
// Throws Error, beginning with `name:line:column:`, for what is also an error in a scene file, and where a
// mesh would have been read in another way for the new material; the scene is then unchanged.
SceneChange change_scene(Scene& scene, std::string_view text, const std::string& name,
                         const std::filesystem::path& folder, SceneEdits& edits,
                         const NamedArrays* arrays = nullptr);

// Gives a scene, which the file of `from` has been read into once more, what changes have replaced in `from`.
// Throws Error, beginning with `name`, as change_scene() does.
void carry_edits(const SceneEdits& edits, const Scene& from, const std::string& name, Scene& to);

}  // namespace candela
