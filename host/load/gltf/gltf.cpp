// See gltf.h: a file as a whole.
#include "load/gltf/gltf.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "base/text.h"
#include "load/gltf/extensions.h"
#include "load/gltf/gltf_file.h"
#include "load/gltf/light.h"
#include "load/gltf/scene_reader.h"
#include "load/gltf/values.h"
#include "scene/default_view.h"

namespace candela {
namespace {

using gltf::File;

// The file's description of itself becomes attributes of images.
void read_attributes(const File& file, Scene& scene) {
    const Node asset = file.root().require("asset");
    for (const char* key : {"generator", "copyright", "version"}) {
        const auto text = asset.find(key);
        if (text && text->is_string())
            scene.attributes.emplace_back(std::string("gltf.") + key, text->string());
    }
    const auto use = gltf::extension_of(asset, "KHR_xmp_json_ld");
    const auto extension = gltf::extension_of(file.root(), "KHR_xmp_json_ld");
    if (!use || !extension) return;
    const Node packets = extension->require("packets");
    const Node number = use->require("packet");
    const uint32_t index = number.integer(0, UINT32_MAX);
    if (index >= packets.size()) number.fail(concat("there are only ", packets.size(), " packets"));
    scene.attributes.emplace_back("gltf.xmp", packets[index].text());
}

void warn_of_units(File& file, const GltfOptions& options, const Scene& scene) {
    if (scene.lights.empty() || options.light_units) return;
    const LightUnits units = units_of(file, options);
    if (units == LightUnits::blender)
        file.warn(file.path().string() +
                  ": Blender wrote the file, so its lights are read as watts times 683 lm/W; if that is too "
                  "dark, use --light-units spec or raw");
    if (units == LightUnits::raw)
        file.warn(file.path().string() +
                  ": a Blender before 3.4 wrote the file, so its lights are read as watts; if that is too "
                  "dark, use --light-units spec");
}

}  // namespace

void add_gltf_scene(const std::filesystem::path& path, const GltfOptions& options, Scene& scene,
                    const LoadProgress& progress, GltfFiles& files) {
    std::shared_ptr<gltf::Contents>& contents = files.contents[path];
    if (!contents) contents = std::make_shared<gltf::Contents>(path, scene.reach, progress);
    File file(*contents, progress);
    check_extensions(file);
    scene.files.push_back(path);
    files.poser = gltf::SceneReader(file, scene, options, progress).read();
    std::ranges::copy(file.files(), std::back_inserter(scene.files));
    read_attributes(file, scene);
    if (!scene.lights.empty())
        scene.attributes.emplace_back("gltf.lightUnits", name_of(units_of(file, options), LIGHT_UNITS_NAMES));
    warn_of_units(file, options, scene);
    std::ranges::copy(file.warnings(), std::back_inserter(scene.warnings));
}

void complete_gltf_scene(const std::string& name, Scene& scene) {
    if (scene.shapes.empty()) scene.warnings.push_back(name + ": the scene has no surfaces");
    if (scene.cameras.empty()) {
        add_default_camera(scene);
        scene.warnings.push_back(
            name +
            ": there is no camera; the scene is seen from the front, a little from the right and above");
    }
}

Scene load_gltf_scene(const std::filesystem::path& path, const GltfOptions& options,
                      const LoadProgress& progress, const ReachOptions& reach) {
    GltfFiles files;
    return load_gltf_scene(path, options, progress, reach, files);
}

Scene load_gltf_scene(const std::filesystem::path& path, const GltfOptions& options,
                      const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files) {
    Scene scene;
    scene.reach = FileReach(path, reach);
    scene.film.size = GLTF_FILM_SIZE;
    add_gltf_scene(path, options, scene, progress, files);
    complete_gltf_scene(path.string(), scene);
    return scene;
}

}  // namespace candela
