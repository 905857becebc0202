// See load.h.
#include "load/load.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
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

Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options) {
    return load_gltf_scene(file, options.gltf, options.progress, options.reach);
}

}  // namespace

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options) {
    using Loader = Scene (*)(const std::filesystem::path&, const LoadOptions&);
    constexpr std::array<std::pair<std::string_view, Loader>, 4> LOADERS{
        {{".glb", &load_gltf},
         {".gltf", &load_gltf},
         {".obj", [](const auto& file,
                     const auto& all) { return refuse(file, all.gltf), load_obj_scene(file, all.reach); }},
         {".ply",
          [](const auto& file, const auto& all) { return refuse(file, all.gltf), load_ply_scene(file); }}}};
    const auto loader =
        std::ranges::find(LOADERS, extension_of(path), [](const auto& known) { return known.first; });
    Scene scene = loader == LOADERS.end()
                      ? load_json_scene(path, options.gltf, options.progress, options.reach)
                      : loader->second(path, options);
    load_images(scene, options.images, options.progress);
    add_studio(scene);
    return scene;
}

}  // namespace candela
