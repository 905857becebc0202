// Scene files: JSON with comments, as scenes/scene.schema.json describes them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "load/gltf/gltf.h"
#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

// Reads a scene and the files that it names, relative to its folder. Throws Error, beginning with
// `file:line:column:` unless the scene file itself cannot be read, for everything that the schema or the
// meaning of a value forbids. What is odd but usable goes to Scene::warnings. `gltf` is for the glTF file
// that it may name. Tells of that file's progress, and then of its own in shapes. `reach` is what the scene
// may name besides what is in its folder.
Scene load_json_scene(const std::filesystem::path& path, const GltfOptions& gltf = {},
                      const LoadProgress& progress = no_progress, const ReachOptions& reach = {});

// The same for the text of a scene file: `file` is its name in messages, and the files that it names are
// relative to `folder` and within `reach`.
Scene parse_scene(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                  const GltfOptions& gltf = {}, const LoadProgress& progress = no_progress,
                  const FileReach& reach = {});

}  // namespace candela
