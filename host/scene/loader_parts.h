// The parts of the scene loader, each of which reads one value of the scene file into structs.
#pragma once

#include <filesystem>

#include "scene/node.h"
#include "scene/scene.h"

namespace candela {

// Reads the camera that stands under its name; its film must have the aspect ratio of `film`.
Camera read_camera(const Node& node, const Film& film);

// Reads the list of shapes into scene.shapes and scene.warnings, and appends a black material to
// scene.materials if an emitter needs one. Files are relative to `folder`; scene.materials is complete.
void read_shapes(const Node& node, const std::filesystem::path& folder, Scene& scene);

}  // namespace candela
