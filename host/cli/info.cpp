// `candela info`: what a scene holds and what rendering it will need. Uses no device.
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/json_text.h"
#include "cli/loading.h"
#include "cli/loading_options.h"
#include "gpu_scene/gpu_scene.h"
#include "render/renderer.h"
#include "scene/geometry.h"
#include "shared/bvh_node.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string scene;
    LoadingOptions loading;
    PictureOptions picture;
    bool json = false;
};

Json to_json(const DoubleBox& box) {
    if (box.is_empty()) return nullptr;
    return {{box.lo.x, box.lo.y, box.lo.z}, {box.hi.x, box.hi.y, box.hi.z}};
}

// Texels of the environment, if there is one.
Json environment_of(const GpuScene& gpu) {
    if (gpu.environment == ENVIRONMENT_NONE) return nullptr;
    return {gpu.environment_size.x, gpu.environment_size.y};
}

// Device memory by part: each array of the scene, and the picture with all AOVs and without any.
Json memory_of(const GpuScene& gpu, RenderSettings settings) {
    settings.aovs = true;
    const uint64_t all = device_bytes(gpu, settings);
    settings.aovs = false;
    const uint64_t colour = device_bytes(gpu, settings);
    Json parts;
    for (const SceneArray& array : SCENE_ARRAYS)
        parts[to_text(array)] = gpu.arrays[array.number].size() * sizeof(uvec4);
    parts["picture"] = all - gpu.bytes();
    parts["picture_without_aovs"] = colour - gpu.bytes();
    return parts;
}

// The images that textures look up.
Json images_of(const Scene& scene) {
    Json images = Json::array();
    for (const ImageFile& file : scene.images) {
        const TexelImage& image = *file.image;
        images.push_back({{"file", file.path.string()},
                          {"width", image.size.x},
                          {"height", image.size.y},
                          {"channels", image.channels},
                          {"bits", 8 * byte_size(image.type)}});
    }
    return images;
}

const char* kind_of(const PointLight&) {
    return "point";
}

const char* kind_of(const SpotLight&) {
    return "spot";
}

const char* kind_of(const DirectionalLight&) {
    return "directional";
}

// The lights without a surface.
Json punctual_lights_of(const Scene& scene) {
    Json lights = Json::array();
    for (const Light& light : scene.lights) {
        const char* kind = std::visit([](const auto& model) { return kind_of(model); }, light.model);
        lights.push_back({{"name", light.name}, {"type", kind}});
    }
    return lights;
}

// What instances save: the triangles of their meshes, as stored and as seen, and about how many more bytes
// copies of the meshes would need.
Json sharing_of(const GpuScene& gpu) {
    uint64_t stored = 0, seen = 0, primitives_saved = 0;
    for (const InstancedMesh& mesh : gpu.meshes)
        stored += mesh.triangles;
    for (const InstancePlace& instance : gpu.instances) {
        seen += gpu.meshes[instance.mesh].triangles;
        primitives_saved += gpu.meshes[instance.mesh].primitives;
    }
    uint64_t bytes = 0;
    for (const uint array : {ARRAY_NODES, ARRAY_PRIMITIVES, ARRAY_SURFACES, ARRAY_NORMALS, ARRAY_ATTRIBUTES})
        bytes += gpu.arrays[array].size() * sizeof(uvec4);
    for (const InstancedMesh& mesh : gpu.meshes)
        primitives_saved -= mesh.primitives;
    const double per_primitive = double(bytes) / double(std::max(gpu.primitive_count, 1u));
    return {{"instances", gpu.instances.size()},
            {"meshes", gpu.meshes.size()},
            {"triangles_stored", stored},
            {"triangles_seen", seen},
            {"bytes_saved", uint64_t(per_primitive * double(primitives_saved))}};
}

Json describe(const InfoOptions& options, const Scene& scene, const GpuScene& gpu) {
    std::vector<std::string> warnings = scene.warnings;
    std::ranges::copy(gpu.warnings, std::back_inserter(warnings));
    RenderSettings settings;
    const uvec2 proposed = scene.cameras.front().film_size.value_or(scene.film.size);
    settings.size = options.picture.size.value_or(proposed);
    settings.crop = options.picture.crop_within(settings.size);
    settings.aovs = true;
    std::vector<std::string> cameras;
    for (const Camera& camera : scene.cameras)
        cameras.push_back(camera.name);
    const PixelRect& crop = settings.crop;
    return {{"scene", options.scene},
            {"primitives", gpu.id_count},
            {"sharing", sharing_of(gpu)},
            {"lights", gpu.light_count},
            {"punctual_lights", punctual_lights_of(scene)},
            {"environment", environment_of(gpu)},
            {"materials", scene.materials.size()},
            {"images", images_of(scene)},
            {"cameras", cameras},
            {"attributes",
             Json(std::map<std::string, std::string>(scene.attributes.begin(), scene.attributes.end()))},
            {"bounds", to_json(bounds(scene))},
            {"bvh_nodes", gpu.arrays[ARRAY_NODES].size() / BVH_NODE_WORDS},
            {"bvh_depth", gpu.bvh_depth},
            {"bvh_sah_cost", gpu.bvh_sah_cost},
            {"bvh_seconds", gpu.bvh_seconds},
            {"width", settings.size.x},
            {"height", settings.size.y},
            {"crop", {crop.x0, crop.y0, crop.x1, crop.y1}},
            {"device_bytes", device_bytes(gpu, settings)},
            {"device_bytes_by_part", memory_of(gpu, settings)},
            {"warnings", summary_of(warnings)}};
}

std::string bounds_text(const Json& bounds) {
    if (bounds.is_null()) return "none";
    const auto point = [](const Json& p) {
        char text[64];
        std::snprintf(text, sizeof text, "(%g, %g, %g)", p[0].get<double>(), p[1].get<double>(),
                      p[2].get<double>());
        return std::string(text);
    };
    return point(bounds[0]) + " to " + point(bounds[1]) + " m";
}

// `3: sun (directional), lamp (spot)`: how many lights there are, and the names of those without a surface.
std::string lights_text(const Json& info) {
    std::vector<std::string> names;
    for (const Json& light : info["punctual_lights"])
        names.push_back(light["name"].get<std::string>() + " (" + light["type"].get<std::string>() + ')');
    return info["lights"].dump() + (names.empty() ? "" : ": " + joined(names));
}

void print(const Json& info) {
    const auto row = [](const char* key, const std::string& value) {
        std::printf("%-14s%s\n", key, printable(value, MAX_MESSAGE_BYTES).c_str());
    };
    const auto bytes = [&info](const std::string& part) {
        return bytes_text(info["device_bytes_by_part"][part].get<uint64_t>());
    };
    row("scene", info["scene"].get<std::string>());
    row("primitives", info["primitives"].dump());
    const Json& sharing = info["sharing"];
    if (sharing["instances"] != 0) {
        row("instances", sharing["instances"].dump() + " of " + sharing["meshes"].dump() +
                             " meshes: " + sharing["triangles_seen"].dump() + " triangles, " +
                             sharing["triangles_stored"].dump() + " stored; saves about " +
                             bytes_text(sharing["bytes_saved"].get<uint64_t>()));
    }
    row("lights", lights_text(info));
    const Json& environment = info["environment"];
    row("environment",
        environment.is_null() ? "none" : environment[0].dump() + 'x' + environment[1].dump() + " texels");
    row("materials", info["materials"].dump());
    if (!info["images"].empty())
        row("images", std::to_string(info["images"].size()) + ", " + bytes("texels"));
    row("cameras", joined(info["cameras"].get<std::vector<std::string>>()));
    for (const auto& [name, text] : info["attributes"].items())
        row((name + ' ').c_str(), text.get<std::string>());
    row("bounds", bounds_text(info["bounds"]));
    row("BVH", info["bvh_nodes"].dump() + " nodes, depth " + info["bvh_depth"].dump() + ", SAH cost " +
                   fixed(info["bvh_sah_cost"].get<double>(), 2) + ", built in " +
                   fixed(1e3 * info["bvh_seconds"].get<double>(), 1) + " ms");
    row("picture",
        info["width"].dump() + 'x' + info["height"].dump() + " pixels, crop " + info["crop"].dump());
    std::string parts;
    for (const SceneArray& array : SCENE_ARRAYS) {
        const std::string name = to_text(array);
        if (info["device_bytes_by_part"][name] != 0) parts += name + ' ' + bytes(name) + ", ";
    }
    row("device memory", bytes_text(info["device_bytes"].get<uint64_t>()) + ": " + parts + "picture " +
                             bytes("picture") + " (" + bytes("picture_without_aovs") + " without AOVs)");
}

ExitCode run(const InfoOptions& options) {
    Scene scene = load_with_progress(options.scene, options.loading);
    const GpuScene gpu = build_with_progress(scene);
    const Json info = describe(options, scene, gpu);
    if (options.json) {
        std::printf("%s\n", json_text(info).c_str());
    } else {
        print(info);
    }
    flush_results();
    return ExitCode::done;
}

}  // namespace

Command add_info_command(CLI::App& app) {
    CLI::App* const command =
        app.add_subcommand("info", "Describe a scene and the memory that it needs; uses no device");
    const auto options = std::make_shared<InfoOptions>();
    command->add_option("SCENE", options->scene, SCENE_FILES)->required()->type_name("");
    options->picture.add_to(*command);
    command->add_flag("--json", options->json, "Print JSON for programs");
    options->loading.add_to(*command);
    return {command, [options] { return run(*options); }};
}

}  // namespace candela
