// Scene files: JSON with comments, as scenes/scene.schema.json describes them.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace candela {

// Reads a scene and the files that it names, relative to its folder. Throws Error, with `file:line:column:`
// in front unless the scene file itself cannot be read, for everything that the schema or the meaning of a
// value forbids. What is odd but usable goes to Scene::warnings.
Scene load_scene(const std::filesystem::path& path);

}  // namespace candela
