// The parts of the scene loader, each of which reads one value of the scene file into structs. All throw
// Error, at the place of what is wrong.
#pragma once

#include <filesystem>

#include "load/json/node.h"
#include "load/json/shape_list.h"
#include "scene/scene.h"

namespace candela {

// Reads the camera that stands under its name; its film must have the aspect ratio of `film`.
Camera read_camera(const Node& node, const Film& film);

// Reads the material that stands under its name.
Material read_material(const Node& node);

// Reads the light from infinitely far away. Its file is relative to `folder`; that and what is odd go to
// scene.files and scene.warnings.
Environment read_environment(const Node& node, const std::filesystem::path& folder, Scene& scene);

// Reads the list of shapes into scene.shapes and scene.warnings, and appends to scene.materials those that
// the shapes bring along: black for an emitter without one, and the materials of OBJ files. Files are
// relative to `folder`; scene.materials holds the materials of the scene file.
void read_shapes(const Node& node, const std::filesystem::path& folder, Scene& scene);

// Round shapes: "sphere" and "disk".
void read_sphere(const Node& node, ShapeList& shapes);
void read_disk(const Node& node, ShapeList& shapes);

// Shapes that are read from files of their own.
void read_obj(const Node& node, ShapeList& shapes);
void read_ply(const Node& node, ShapeList& shapes);

}  // namespace candela
