// The scene file as a whole, and its small parts.
#include "load/json/loader.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "load/json/loader_parts.h"
#include "load/quote.h"
#include "scene/default_filter.h"
#include "scene/names.h"

namespace candela {
namespace {

Film read_film(const Node& node) {
    node.allow_only({}, keys_of({"film"}));
    const SceneKey side = scene_key("film", "size");
    const Node size = node.require("size");
    const std::vector<Node> sides = size.elements();
    if (sides.size() != 2) size.fail_expected("two whole numbers [width, height]");
    Film film{.size = uvec2(read_integer(sides[0], side), read_integer(sides[1], side))};
    const auto shape = node.find("filter"), width = node.find("filter_width");
    if (shape) film.filter = default_filter(shape->choice(FILTER_SHAPE_NAMES));
    if (width) {
        if (!shape) width->fail("filter_width is the width of a filter; add \"filter\"");
        film.filter.width = read_number(*width, scene_key("film", "filter_width"));
    }
    return film;
}

IntegratorSettings read_integrator(const Node& node) {
    node.allow_only({}, keys_of({"integrator"}));
    IntegratorSettings settings;
    if (const auto spp = node.find("spp")) settings.spp = read_integer(*spp, scene_key("integrator", "spp"));
    if (const auto depth = node.find("max_depth")) {
        const bool unlimited = depth->is_string() && depth->string() == "unlimited";
        if (!unlimited && !depth->is_number()) depth->fail_expected("a whole number or \"unlimited\"");
        if (!unlimited) settings.max_depth = read_integer(*depth, scene_key("integrator", "max_depth"));
    }
    if (const auto depth = node.find("rr_depth"))
        settings.rr_depth = read_integer(*depth, scene_key("integrator", "rr_depth"));
    if (const auto estimator = node.find("estimator"))
        settings.estimator = estimator->choice(ESTIMATOR_NAMES);
    if (const auto sampler = node.find("sampler")) settings.sampler = sampler->choice(SAMPLER_NAMES);
    if (const auto sampler = node.find("light_sampler"))
        settings.light_sampler = sampler->choice(LIGHT_SAMPLER_NAMES);
    if (const auto terminator = node.find("terminator"))
        settings.terminator = terminator->choice(TERMINATOR_NAMES);
    if (const auto limit = node.find("clamp_indirect")) settings.clamp_indirect = float(limit->positive());
    if (const auto seed = node.find("seed"))
        settings.seed = read_integer(*seed, scene_key("integrator", "seed"));
    return settings;
}

// Reads the glTF file that the scene adds to.
void read_base(const Node& node, const std::filesystem::path& folder, const GltfOptions& gltf, Scene& scene,
               const LoadProgress& progress, GltfFiles& files) {
    const std::filesystem::path path = find_file(node, folder, scene.reach);
    const HiddenValues hidden(scene.reach);
    try {
        add_gltf_scene(path, gltf, scene, progress, files);
    } catch (const Error& error) {
        throw Error(node.place() + ": " + error.what(), error.kind());
    }
}

// Nothing comes through a medium without an end.
void warn_of_hidden_lights(const Node& root, Scene& scene) {
    const bool sun = std::ranges::any_of(scene.lights, [](const Light& light) {
        return std::holds_alternative<DirectionalLight>(light.model);
    });
    if (scene.medium.scattering + scene.medium.absorption == vec3(0.0f) || !(scene.environment || sun))
        return;
    scene.warnings.push_back(
        root.require("medium").place() +
        ": the medium has no end, so that no light of the sky or of suns comes through it; give it "
        "to an \"interface\" around the scene instead");
}

JsonScene scene_of(const json::Document& document, const std::filesystem::path& folder,
                   const GltfOptions& gltf, const LoadProgress& progress, const FileReach& reach,
                   GltfFiles& files, const NamedArrays* arrays = nullptr) {
    const Node root(document);
    root.allow_only({"$schema"}, keys_of({"scene"}));

    Scene scene;
    scene.reach = reach;
    scene.arrays = arrays;
    const auto base = root.find("scene");
    if (!base && gltf != GltfOptions{})
        throw Error(document.file + ": " + GLTF_OPTIONS_ALONE, ErrorKind::request);
    if (base) scene.film.size = GLTF_FILM_SIZE;
    if (const auto film = root.find("film")) scene.film = read_film(*film);
    if (const auto cameras = base ? root.find("cameras") : root.require("cameras")) {
        for (const Node& camera : cameras->members())
            scene.cameras.push_back(read_camera(camera, scene.film));
        if (scene.cameras.empty() && !base) cameras->fail("the scene has no camera; add one");
    }
    if (const auto integrator = root.find("integrator")) scene.integrator = read_integrator(*integrator);
    if (const auto materials = root.find("materials")) {
        for (const Node& material : materials->members())
            scene.materials.push_back(read_material(material, {folder, scene}));
    }
    if (base) read_base(*base, folder, gltf, scene, progress, files);
    if (root.find("film")) {
        for (Camera& camera : scene.cameras)
            camera.film_size.reset();
    }
    const auto shapes = base ? root.find("shapes") : root.require("shapes");
    const auto objects = root.find("objects");
    if (objects && !shapes) objects->fail("objects are only seen where shapes place them; add \"shapes\"");
    if (shapes) read_shapes(*shapes, objects, folder, scene, progress);
    if (const auto lights = root.find("lights"))
        std::ranges::move(read_lights(*lights, scene), std::back_inserter(scene.lights));
    if (const auto medium = root.find("medium")) scene.medium = read_medium(*medium);
    if (auto environment = read_distant_light(root, folder, scene))
        scene.environment = std::move(environment);

    warn_of_hidden_lights(root, scene);
    if (base) {
        complete_gltf_scene(base->place(), scene);
        return {std::move(scene), base->place(), true};
    }
    if (scene.shapes.empty() && !scene.environment)
        scene.warnings.push_back(shapes->place() + ": the scene has no shapes");
    return {std::move(scene), shapes->place(), false};
}

}  // namespace

JsonScene load_json_scene(const std::filesystem::path& path, const GltfOptions& gltf,
                          const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files) {
    const std::string file = path.string();
    const json::Document document{file, json::parse(read_file(path), file)};
    const Node root(document);
    if (root.is_object() && root.find("asset"))
        return {load_gltf_scene(path, gltf, progress, reach, files), file, true};
    return scene_of(document, path.parent_path(), gltf, progress, FileReach(path, reach), files);
}

JsonScene parse_json_scene(std::string_view text, const std::filesystem::path& path, const GltfOptions& gltf,
                           const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files,
                           const NamedArrays* arrays) {
    const std::string file = path.string();
    return scene_of({file, json::parse(text, file)}, path.parent_path(), gltf, progress,
                    FileReach(path, reach), files, arrays);
}

Scene parse_scene(std::string_view text, const std::string& file) {
    GltfFiles files;
    return scene_of({file, json::parse(text, file)}, {}, {}, no_progress, {}, files).scene;
}

}  // namespace candela
