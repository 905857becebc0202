// The environment: a constant sky, one from an image, or a computed one.
#include <array>

#include "base/error.h"
#include "load/json/arrays.h"
#include "load/json/loader_parts.h"
#include "scene/environment.h"
#include "scene/geometry.h"
#include "scene/sky.h"

namespace candela {
namespace {

// Loads the image that `file` names; its warnings and errors get the place of `file` in front.
Environment load(const Node& file, const std::filesystem::path& folder, Scene& scene) {
    const std::filesystem::path path = find_file(file, folder, scene.reach);
    try {
        std::vector<std::string> odd;
        Environment environment = load_environment(path, scene.reach, odd);
        for (const std::string& warning : odd)
            scene.warnings.push_back(file.place() + ": " + warning);
        return environment;
    } catch (const Error& error) {
        throw Error(file.place() + ": " + error.what(), error.kind());
    }
}

// Multiplies all radiance by the intensity that `node` gives.
void scale(Environment& environment, const Node& node) {
    const double intensity = node.non_negative();
    for (vec3& radiance : environment.radiance) {
        const glm::dvec3 scaled = intensity * glm::dvec3(radiance);
        if (glm::any(glm::greaterThan(scaled, glm::dvec3(FLOAT_MAX)))) {
            node.fail("radiance times intensity exceeds the range of 32-bit floats; lower the intensity");
        }
        radiance = vec3(scaled);
    }
}

// The latitude-longitude map that an array is, of height x width x 3 numbers.
Environment read_map(const Node& node, const Scene& scene) {
    const std::array<uint64_t, 3> shape = map_shape(node, scene);
    const ArrayRows rows(node, scene, {shape[1] * shape[2]});
    Environment environment{.size = uvec2(uint32_t(shape[1]), uint32_t(shape[0])), .radiance = {}};
    environment.radiance.reserve(shape[0] * shape[1]);
    rows.for_each([&](uint64_t row, const double* numbers) {
        for (uint64_t i = 0; i < rows.columns(); i += 3) {
            const dvec3 radiance(numbers[i], numbers[i + 1], numbers[i + 2]);
            for (const int c : {0, 1, 2})
                if (radiance[c] < 0.0) rows.fail(row, "radiance of at least 0", radiance[c]);
            environment.radiance.emplace_back(radiance);
        }
    });
    return environment;
}

Environment read_environment(const Node& node, const std::filesystem::path& folder, Scene& scene) {
    node.allow_only({}, keys_of({"environment"}));
    const auto file = node.find("file");
    const auto radiance = node.find("radiance");
    if (file.has_value() == radiance.has_value()) {
        node.fail(R"(the environment needs either "file", an image, or "radiance", a constant)");
    }
    Environment environment;
    if (file) {
        environment = load(*file, folder, scene);
        scene.files.push_back(folder / file->string());
    }
    const bool is_map = radiance && is_array_name(*radiance);
    if (is_map) {
        environment = read_map(*radiance, scene);
    } else if (radiance) {
        environment.radiance = {vec3(radiance->rgb())};
    }
    const bool reported = file && !gives_light(environment);  // Already, by load_environment().
    if (const auto rotation = node.find("rotation")) {
        if (!file && !is_map) {
            rotation->fail(
                "a constant environment looks the same in all directions; rotation needs \"file\"");
        }
        environment.rotation = float(rotation->angle());
    }
    if (const auto intensity = node.find("intensity")) scale(environment, *intensity);
    if (const auto visible = node.find("visible")) environment.visible = visible->boolean();
    if (!gives_light(environment) && !reported) {
        scene.warnings.push_back(node.place() + ": the environment is black: it gives no light");
    }
    return environment;
}

Environment read_sky(const Node& node) {
    node.allow_only({}, keys_of({"sky"}));
    Sky sky;
    const float elevation = read_number(node.require("sun_elevation"), scene_key("sky", "sun_elevation"));
    sky.sun_elevation = glm::radians(double(elevation));
    if (const auto azimuth = node.find("sun_azimuth")) sky.sun_azimuth = azimuth->angle();
    if (const auto turbidity = node.find("turbidity"))
        sky.turbidity = double(read_number(*turbidity, scene_key("sky", "turbidity")));
    if (const auto ground = node.find("ground")) sky.ground = vec3(ground->reflectance());
    Environment environment = sky_environment(sky);
    if (const auto intensity = node.find("intensity")) scale(environment, *intensity);
    if (const auto visible = node.find("visible")) environment.visible = visible->boolean();
    return environment;
}

}  // namespace

std::optional<Environment> read_distant_light(const Node& root, const std::filesystem::path& folder,
                                              Scene& scene) {
    const auto environment = root.find("environment"), sky = root.find("sky");
    if (environment && sky)
        sky->fail(
            R"(the scene already has an "environment", and the sky is one, too; leave one of them out)");
    if (environment) return read_environment(*environment, folder, scene);
    if (sky) return read_sky(*sky);
    return std::nullopt;
}

}  // namespace candela
