// Changes of a loaded scene, in the syntax of scene files.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "scene/scene.h"
#include "scene/scene_change.h"

namespace candela {

// What of a scene changes have replaced: cameras and materials of these names, and perhaps the environment.
struct SceneEdits {
    std::set<std::string> cameras{}, materials{};
    bool environment = false;
};

// Reads `text`, an object with any of the keys "cameras", "materials", "environment" and "sky" of a scene
// file, and replaces cameras and materials of the same names, and the environment. A camera of a new name
// joins the others. Shapes without an emission of their own emit as their new material does. Files are
// relative to `folder` and within scene.reach; images are read anew. What is replaced joins `edits`. Returns
// what has changed of the scene, besides cameras.
//
// Throws Error, beginning with `name:line:column:`, for what is also an error in a scene file, and where a
// mesh would have been read in another way for the new material; the scene is then unchanged.
SceneChange change_scene(Scene& scene, std::string_view text, const std::string& name,
                         const std::filesystem::path& folder, SceneEdits& edits);

// Gives a scene, which the file of `from` has been read into once more, what changes have replaced in `from`.
// Throws Error, beginning with `name`, as change_scene() does.
void carry_edits(const SceneEdits& edits, const Scene& from, const std::string& name, Scene& to);

}  // namespace candela
