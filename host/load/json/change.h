// Changes of a loaded scene, in the syntax of scene files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace candela {

// Reads `text`, an object with any of the keys "cameras", "materials" and "environment" of a scene file, and
// replaces cameras and materials of the same names, and the environment. A camera of a new name joins the
// others. Shapes without an emission of their own emit as their new material does. Files are relative to
// `folder` and within scene.reach; images are read anew. Returns whether more than cameras was changed.
//
// Throws Error, beginning with `name:line:column:`, for what is also an error in a scene file, and where a
// mesh would have been read in another way for the new material; the scene is then unchanged.
bool change_scene(Scene& scene, std::string_view text, const std::string& name,
                  const std::filesystem::path& folder);

}  // namespace candela
