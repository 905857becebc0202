// How scene files are read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/lighting_options.h"
#include "load/gltf/gltf.h"
#include "scene/scene.h"

namespace candela {

// What the argument SCENE of a command may name.
inline constexpr const char* SCENE_FILES =
    "Scene file (.json, .gltf, .glb, .obj, .ply, and .blend where there is a Blender)";

struct LoadingOptions {
    std::optional<uint32_t> texture_limit;  // Texels along a side of an image.
    IfMissing missing_images = IfMissing::white;
    std::vector<std::string> folders;      // Files may be read from these, too.
    bool any_folder = false;               // Whether they may be read from anywhere.
    std::optional<uint64_t> memory_limit;  // Bytes; none: default_memory_limit().
    GltfOptions gltf;
    LightingArguments lighting;
    bool double_sided = false;

    // Declares them on `app`, in the second case only those on files and memory; this object must not move.
    void add_to(CLI::App& app);
    void add_limits_to(CLI::App& app);
};

}  // namespace candela
