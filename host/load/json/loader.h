// Scene files: JSON with comments, as scenes/scene.schema.json describes them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "load/gltf/gltf.h"
#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

// A scene before its images are read. (They decide whether it has light.)
struct JsonScene {
    Scene scene;
    std::string place;     // Messages about its light begin with this.
    bool is_gltf = false;  // Whether it is a glTF file, or names one.
};

// Reads a scene and the files that it names, relative to its folder. Throws Error, beginning with
// `file:line:column:` unless the scene file itself cannot be read, for everything that the schema or the
// meaning of a value forbids. Scene::warnings gets what is odd but usable. `gltf` is for the glTF file that
// the scene may name, which is added to `files` unless it is there. Reports that file's progress, and then
// its own in shapes. `reach` allows files outside the scene's folder.
JsonScene load_json_scene(const std::filesystem::path& path, const GltfOptions& gltf,
                          const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files);

// The same for the text of a scene, which `path` names in messages, and which is not glTF; there need not be
// such a file. It may name `arrays`.
JsonScene parse_json_scene(std::string_view text, const std::filesystem::path& path, const GltfOptions& gltf,
                           const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files,
                           const NamedArrays* arrays = nullptr);

// The same for the text of a scene file that names no other files; `file` is its name in messages.
Scene parse_scene(std::string_view text, const std::string& file);

}  // namespace candela
