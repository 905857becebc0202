// Scenes from files.
#pragma once

#include <filesystem>

#include "scene/images.h"
#include "scene/scene.h"

namespace candela {

// Reads a scene and the files that it names. The extension, in upper or lower case, chooses the format: OBJ
// or PLY; otherwise JSON. Throws Error, beginning with the place, for whatever the format or the meaning of a
// value forbids. What is odd but usable goes to Scene::warnings.
Scene load_scene(const std::filesystem::path& path, const ImageOptions& images = {});

}  // namespace candela
