// Scenes from files.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace candela {

// Reads a scene and the files that it names. JSON is the only format of whole scenes so far, whatever the
// extension; others are to be chosen here. Throws Error, with a place in front, for whatever the format or
// the meaning of a value forbids. What is odd but usable goes to Scene::warnings.
Scene load_scene(const std::filesystem::path& path);

}  // namespace candela
