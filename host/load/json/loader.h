// Scene files: JSON with comments, as scenes/scene.schema.json describes them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "load/gltf/gltf.h"
#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

// A scene whose images have not been read, which decide whether it has light.
struct JsonScene {
    Scene scene;
    std::string place;     // What messages about its light begin with.
    bool is_gltf = false;  // Whether it is a glTF file, or names one.
};

// Reads a scene and the files that it names, relative to its folder. Throws Error, beginning with
// `file:line:column:` unless the scene file itself cannot be read, for everything that the schema or the
// meaning of a value forbids. What is odd but usable goes to Scene::warnings. `gltf` is for the glTF file
// that it may name, which joins `files` unless it is there. Tells of that file's progress, and then of its
// own in shapes. `reach` is what the scene may name besides what is in its folder.
JsonScene load_json_scene(const std::filesystem::path& path, const GltfOptions& gltf,
                          const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files);

// The same for the text of a scene file that names no other files; `file` is its name in messages.
Scene parse_scene(std::string_view text, const std::string& file);

}  // namespace candela
