// See load.h.
#include "load/load.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/image_io_parts.h"
#include "load/json/loader.h"
#include "load/obj/obj.h"
#include "load/ply/ply.h"

namespace candela {
namespace {

// Throws Error for options that a file has no use for.
void refuse(const std::filesystem::path& file, const GltfOptions& options) {
    if (options == GltfOptions{}) return;
    throw Error(file.string() + ": " + GLTF_OPTIONS_ALONE, ExitCode::usage);
}

enum class Format { gltf, obj, ply, json };

// The first bytes of a regular file: those of a pipe can be read only once.
std::string start_of(const std::filesystem::path& path) {
    constexpr size_t LONGEST = 16;
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) ? read_file_start(path, LONGEST).bytes : "";
}

// What a file is: its first bytes say so if they are unmistakable, otherwise its extension.
Format format_of(const std::filesystem::path& path) {
    constexpr std::array<std::pair<std::string_view, Format>, 4> BY_CONTENT{
        {{"glTF", Format::gltf},
         {"ply\n", Format::ply},
         {"ply\r", Format::ply},
         {"\xEF\xBB\xBFply", Format::ply}}};
    constexpr std::array<std::pair<std::string_view, Format>, 4> BY_EXTENSION{
        {{".glb", Format::gltf}, {".gltf", Format::gltf}, {".obj", Format::obj}, {".ply", Format::ply}}};
    const std::string start = start_of(path), extension = extension_of(path);
    for (const auto& [bytes, format] : BY_CONTENT) {
        if (start.starts_with(bytes)) return format;
    }
    for (const auto& [name, format] : BY_EXTENSION) {
        if (extension == name) return format;
    }
    return Format::json;
}

Scene load(const std::filesystem::path& path, const LoadOptions& options) {
    switch (format_of(path)) {
        case Format::gltf:
            return load_gltf_scene(path, options.gltf, options.progress, options.reach);
        case Format::obj:
            refuse(path, options.gltf);
            return load_obj_scene(path, options.reach);
        case Format::ply:
            refuse(path, options.gltf);
            return load_ply_scene(path);
        case Format::json:
            break;
    }
    return load_json_scene(path, options.gltf, options.progress, options.reach);
}

}  // namespace

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options) {
    Scene scene = load(path, options);
    load_images(scene, options.images, options.progress);
    add_studio(scene, options.gltf.studio.value_or(StudioChoice::automatic));
    return scene;
}

}  // namespace candela
