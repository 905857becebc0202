// See gltf.h: a file as a whole.
#include "load/gltf/gltf.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

#include "base/image_io_parts.h"
#include "base/text.h"
#include "load/gltf/extensions.h"
#include "load/gltf/gltf_file.h"
#include "load/gltf/light.h"
#include "load/gltf/scene_reader.h"
#include "load/gltf/values.h"
#include "scene/default_view.h"
#include "scene/geometry.h"
#include "scene/materials.h"

namespace candela {
namespace {

using gltf::File;

// What the file says of itself goes into images.
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

// Whether at least half of an image, but for noise of its compression, is not black.
bool is_bright(const TexelImage& image) {
    constexpr float BLACK = 0.05f;
    constexpr size_t LOOKS = 65536;  // Spread over the image.
    const size_t count = size_t(image.size.x) * image.size.y, step = count / LOOKS + 1;
    size_t bright = 0, looks = 0;
    for (size_t i = 0; i < count; i += step, ++looks)
        bright += any(greaterThan(vec3(texel_codes(image, i)), vec3(BLACK)));
    return 2 * bright >= looks;
}

// Whether people would see the scene: by its lights, by surfaces that emit, or since all surfaces need no
// light.
bool is_lit(const Scene& scene) {
    std::map<uint32_t, bool> bright;  // Images.
    const auto emits = [&](const Shape& shape) {
        if (!shape.emission || shape.emission->radiance.factor == vec3(0.0f)) return false;
        const std::optional<Texture>& texture = shape.emission->radiance.texture;
        if (!texture) return true;
        const auto [known, is_new] = bright.try_emplace(texture->image);
        if (is_new) known->second = is_bright(scene.images[texture->image].image);
        return known->second;
    };
    const auto needs_no_light = [&](const Shape& shape) { return is_unlit(scene.materials[shape.material]); };
    return std::ranges::any_of(scene.lights, [](const Light& light) { return gives_light(light); }) ||
           std::ranges::any_of(scene.shapes, emits) ||
           (!scene.shapes.empty() && std::ranges::all_of(scene.shapes, needs_no_light));
}

void warn_of_units(File& file, const GltfOptions& options, const Scene& scene) {
    if (scene.lights.empty() || options.light_units) return;
    const LightUnits units = units_of(file, options);
    if (units == LightUnits::blender)
        file.warn(file.path().string() +
                  ": Blender wrote the file, so that its lights count as watts times 683 lm/W; where that is "
                  "too dark, give --light-units spec or raw");
    if (units == LightUnits::raw)
        file.warn(file.path().string() +
                  ": a Blender before 3.4 wrote the file, so that its lights count as watts; where that is "
                  "too dark, give --light-units spec");
}

}  // namespace

bool is_gltf(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    return extension == ".gltf" || extension == ".glb";
}

void add_gltf_scene(const std::filesystem::path& path, const GltfOptions& options, Scene& scene,
                    const LoadProgress& progress) {
    File file(path, scene.reach, progress);
    check_extensions(file);
    scene.files.push_back(path);
    gltf::SceneReader(file, scene, options, progress).read();
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
    scene.studio_place = name;
}

void add_studio(Scene& scene) {
    if (!scene.studio_place || scene.environment || is_lit(scene)) return;
    scene.environment = gltf::studio();
    const char* cause =
        emitter_count(scene) > 0 ? ": what emits light is mostly black" : ": there is no light";
    scene.warnings.push_back(*scene.studio_place + cause +
                             "; a studio lights the scene, which the camera does not see");
}

Scene load_gltf_scene(const std::filesystem::path& path, const GltfOptions& options,
                      const LoadProgress& progress, const ReachOptions& reach) {
    Scene scene;
    scene.reach = FileReach(path, reach);
    scene.film.size = GLTF_FILM_SIZE;
    add_gltf_scene(path, options, scene, progress);
    complete_gltf_scene(path.string(), scene);
    return scene;
}

}  // namespace candela
