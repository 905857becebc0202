// Scenes from files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "load/gltf/gltf.h"
#include "load/lighting.h"
#include "scene/images.h"
#include "scene/load_progress.h"
#include "scene/scene.h"

namespace candela {

struct LoadOptions {
    ImageOptions images{};
    GltfOptions gltf{};  // Also for a glTF file that a JSON scene names.
    LightingOptions lighting{};
    bool double_sided = false;  // make_double_sided().
    LoadProgress progress = no_progress;
    ReachOptions reach{};  // The files that may be named outside the folder of `path`.
    // What a native scene says. There is then no file: `path` names it in messages, in the folder of the
    // files that it names.
    std::optional<std::string> text{};
    // The arrays that this text may name; needed only while the scene is loaded.
    const NamedArrays* arrays = nullptr;
};

// Files shared by several scenes, such as the same one at several times: parsed glTF files and decoded
// images. The files must not change.
struct LoadedFiles {
    GltfFiles gltf{};
    DecodedImages images{};
};

// Reads a scene and the files that it names. The first bytes of a file determine its format if they are
// unmistakable: binary glTF, PLY, and JSON with the "asset" of glTF. Otherwise its extension does, in upper
// or lower case: glTF, OBJ or PLY; JSON for any other. Throws Error, beginning with the place, for everything
// that the format or the meaning of a value forbids, and Error (usage) for options of glTF if no such file is
// read. Scene::warnings gets what is odd but usable.
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

// The same, bit for bit, but does not read again what is in `files`, and adds what it reads. All options but
// those of glTF must be the same for all scenes of these files.
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options, LoadedFiles& files);

}  // namespace candela
