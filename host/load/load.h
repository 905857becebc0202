// Scenes from files.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace candela {

// Reads a scene and the files that it names, in the format that the extension says, in upper or lower case:
// OBJ and PLY; JSON with any other. Throws Error, with a place in front, for whatever the format or the
// meaning of a value forbids. What is odd but usable goes to Scene::warnings.
Scene load_scene(const std::filesystem::path& path);

}  // namespace candela
