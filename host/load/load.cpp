// See load.h.
#include "load/load.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "load/json/loader.h"
#include "load/obj/obj.h"
#include "load/ply/ply.h"
#include "scene/seen_from_behind.h"

namespace candela {
namespace {

// Throws Error for options that do not apply to a file.
void refuse(const std::filesystem::path& file, const GltfOptions& options) {
    if (options == GltfOptions{}) return;
    throw Error(file.string() + ": " + GLTF_OPTIONS_ALONE, ErrorKind::request);
}

enum class Format { gltf, obj, ply, json };

// The first bytes of a regular file: those of a pipe can be read only once.
std::string start_of(const std::filesystem::path& path) {
    constexpr size_t LONGEST = 16;
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) ? read_file_start(path, LONGEST).bytes : "";
}

// The format of a file, by its first bytes if they are unmistakable, otherwise by its extension.
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

// `is_last`: no other scene shows the glTF files.
Scene load(const std::filesystem::path& path, const LoadOptions& options, LoadedFiles& files, bool is_last) {
    const GltfOptions& gltf = options.gltf;
    Scene scene;
    std::string place = path.string();
    SceneSource source = SceneSource::mesh;
    switch (options.text ? Format::json : format_of(path)) {
        case Format::gltf:
            scene = load_gltf_scene(path, gltf, options.progress, options.reach, files.gltf);
            source = SceneSource::gltf;
            break;
        case Format::obj:
            refuse(path, gltf);
            scene = load_obj_scene(path, options.reach);
            break;
        case Format::ply:
            refuse(path, gltf);
            scene = load_ply_scene(path);
            break;
        case Format::json: {
            JsonScene json = options.text
                                 ? parse_json_scene(*options.text, path, gltf, options.progress,
                                                    options.reach, files.gltf, options.arrays)
                                 : load_json_scene(path, gltf, options.progress, options.reach, files.gltf);
            scene = std::move(json.scene);
            place = json.place;
            source = json.is_gltf ? SceneSource::gltf : SceneSource::native;
        }
    }
    if (is_last) files.gltf.contents.clear();
    load_images(scene, options.images, options.progress, files.images);
    scene.arrays = nullptr;
    if (options.double_sided) make_double_sided(scene);
    light_scene(scene, place, source, options.lighting);
    return scene;
}

}  // namespace

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options) {
    LoadedFiles files;
    return load(path, options, files, true);
}

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options, LoadedFiles& files) {
    return load(path, options, files, false);
}

}  // namespace candela
