// Scenes from files of any format.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace candela {

// Reads a scene and the files that it names, by the format that its extension tells; any that is unknown is
// taken for JSON. Throws Error, with a place in front, for whatever the format or the meaning of a value
// forbids. What is odd but usable goes to Scene::warnings.
Scene load_scene(const std::filesystem::path& path);

}  // namespace candela
