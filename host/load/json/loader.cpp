// The scene file as a whole, and its small parts.
#include "load/json/loader.h"

#include <algorithm>

#include "base/file.h"
#include "load/json/loader_parts.h"
#include "scene/geometry.h"
#include "scene/names.h"

namespace candela {
namespace {

Film read_film(const Node& node) {
    constexpr uint32_t MOST_PIXELS = 65536;  // Along one side.
    node.allow_only({"size"});
    const Node size = node.require("size");
    const std::vector<Node> sides = size.elements();
    if (sides.size() != 2) size.fail_expected("two whole numbers [width, height]");
    return {uvec2(sides[0].integer(1, MOST_PIXELS), sides[1].integer(1, MOST_PIXELS))};
}

IntegratorSettings read_integrator(const Node& node) {
    constexpr uint32_t MOST_SAMPLES = 1u << 24;  // The count is kept as a float.
    constexpr uint32_t MOST_BOUNCES = 4096;      // The safety limit of unlimited paths.
    node.allow_only({"spp", "max_depth", "rr_depth", "estimator", "sampler", "seed"});
    IntegratorSettings settings;
    if (const auto spp = node.find("spp")) settings.spp = spp->integer(1, MOST_SAMPLES);
    if (const auto depth = node.find("max_depth")) {
        const bool unlimited = depth->is_string() && depth->string() == "unlimited";
        if (!unlimited && !depth->is_number()) depth->fail_expected("a whole number or \"unlimited\"");
        if (!unlimited) settings.max_depth = depth->integer(0, MOST_BOUNCES);
    }
    if (const auto depth = node.find("rr_depth")) settings.rr_depth = depth->integer(0, MOST_BOUNCES);
    if (const auto estimator = node.find("estimator"))
        settings.estimator = estimator->choice(ESTIMATOR_NAMES);
    if (const auto sampler = node.find("sampler")) settings.sampler = sampler->choice(SAMPLER_NAMES);
    if (const auto seed = node.find("seed")) settings.seed = seed->integer(0, ~0u);
    return settings;
}

// Whether a shape shows a colour without any light.
bool has_unlit_shape(const Scene& scene) {
    return std::ranges::any_of(scene.shapes, [&](const Shape& shape) {
        const auto* m = std::get_if<PrincipledMaterial>(&scene.materials[shape.material].model);
        return m != nullptr && m->unlit;
    });
}

// Whether the picture shows anything but black.
bool has_light(const Scene& scene) {
    const bool lit = std::ranges::any_of(scene.lights, [](const Light& light) { return gives_light(light); });
    return lit || emitter_count(scene) > 0 || (scene.environment && gives_light(*scene.environment)) ||
           has_unlit_shape(scene);
}

}  // namespace

Scene load_json_scene(const std::filesystem::path& path) {
    return parse_scene(read_file(path), path.string(), path.parent_path());
}

Scene parse_scene(std::string_view text, const std::string& file, const std::filesystem::path& folder) {
    const json::Value document = json::parse(text, file);
    const Node root(file, "", document);
    root.allow_only(
        {"$schema", "cameras", "film", "integrator", "materials", "shapes", "lights", "environment"});

    Scene scene;
    if (const auto film = root.find("film")) scene.film = read_film(*film);
    const Node cameras = root.require("cameras");
    for (const Node& camera : cameras.members())
        scene.cameras.push_back(read_camera(camera, scene.film));
    if (scene.cameras.empty()) cameras.fail("the scene has no camera; add one");
    if (const auto integrator = root.find("integrator")) scene.integrator = read_integrator(*integrator);
    if (const auto materials = root.find("materials")) {
        for (const Node& material : materials->members())
            scene.materials.push_back(read_material(material, {folder, scene}));
    }
    const Node shapes = root.require("shapes");
    read_shapes(shapes, folder, scene);
    if (const auto lights = root.find("lights")) scene.lights = read_lights(*lights, scene);
    if (const auto environment = root.find("environment")) {
        scene.environment = read_environment(*environment, folder, scene);
    }

    if (scene.shapes.empty() && !scene.environment) {
        scene.warnings.push_back(shapes.place() + ": the scene has no shapes");
    } else if (!has_light(scene)) {
        scene.warnings.push_back(shapes.place() + ": the scene has no light: the image will be black");
    }
    return scene;
}

}  // namespace candela
