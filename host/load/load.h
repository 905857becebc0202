// Scenes from files.
#pragma once

#include <filesystem>

#include "load/gltf/gltf.h"
#include "scene/images.h"
#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

struct LoadOptions {
    ImageOptions images{};
    GltfOptions gltf{};  // Also for a glTF file that a JSON scene names.
    LoadProgress progress = no_progress;
    ReachOptions reach{};  // What the files may name besides what is in the folder of `path`.
};

// What is read once for scenes that show the same files, such as at several times: parsed glTF files and
// decoded images. The files are taken not to change.
struct LoadedFiles {
    GltfFiles gltf{};
    DecodedImages images{};
};

// Reads a scene and the files that it names. The first bytes of a file say its format where they are
// unmistakable: binary glTF, PLY, and JSON with the "asset" of glTF. Otherwise its extension does, in upper
// or lower case: glTF, OBJ or PLY; else JSON. Throws Error, beginning with the place, for whatever the format
// or the meaning of a value forbids, and Error (usage) for options of glTF if no such file is read. What is
// odd but usable goes to Scene::warnings.
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

// The same, bit for bit, but reads nothing again that is among `files`, which what it reads joins. Other
// options than those of glTF must be the same for all scenes of these files.
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options, LoadedFiles& files);

}  // namespace candela
