// See load.h.
#include "load/load.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "load/json/loader.h"
#include "load/obj/obj.h"
#include "load/ply/ply.h"

namespace candela {

Scene load_scene(const std::filesystem::path& path, const ImageOptions& images) {
    using Loader = Scene (*)(const std::filesystem::path&);
    constexpr std::array<std::pair<std::string_view, Loader>, 2> LOADERS{
        {{".obj", &load_obj_scene}, {".ply", &load_ply_scene}}};
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    const auto loader = std::ranges::find(LOADERS, extension, [](const auto& known) { return known.first; });
    Scene scene = loader == LOADERS.end() ? load_json_scene(path) : loader->second(path);
    load_images(scene, images);
    return scene;
}

}  // namespace candela
