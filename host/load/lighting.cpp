// See lighting.h.
#include "load/lighting.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/file_reach.h"
#include "scene/environment.h"
#include "scene/geometry.h"
#include "scene/glow.h"
#include "scene/materials.h"

namespace candela {
namespace {

// The least light, relative to the studio's, in which the scene would be visible.
constexpr double MIN_LIGHT = 0.1;

// The light of a scene besides the studio.
enum class Lit {
    dark,     // Nothing.
    dimly,    // The emitters are too small or too dark.
    by_name,  // The same, but an emitter is brighter than white, as lights are.
    fully,
};

Lit light_of(const Scene& scene, const Environment& studio) {
    const auto needs_no_light = [&](const Shape& shape) { return is_unlit(scene.materials[shape.material]); };
    // Meshes may only glow, as toys do. A native scene's other shapes are meant as lights.
    const auto is_lamp = [](const Shape& shape) {
        return shape.emission && !std::holds_alternative<MeshInstance>(shape.geometry);
    };
    if (std::ranges::any_of(scene.lights, [](const Light& light) { return gives_light(light); }) ||
        std::ranges::any_of(scene.shapes, is_lamp) ||
        (!scene.shapes.empty() && std::ranges::all_of(scene.shapes, needs_no_light)))
        return Lit::fully;
    if (emitter_count(scene) == 0) return Lit::dark;
    constexpr double GLOWING_AREA = 0.5;
    const double min = MIN_LIGHT * mean_radiance(studio);
    const Glow glow = glow_of(scene, min);
    if (glow.radiance >= min || glow.area >= GLOWING_AREA) return Lit::fully;
    return glow.above_white ? Lit::by_name : Lit::dimly;
}

bool is_named(StudioChoice studio) {
    return studio != StudioChoice::automatic && studio != StudioChoice::off;
}

// Adds the studio if nothing else lights the scene of a glTF file, or a warning.
void add_studio(Scene& scene, const std::string& name, StudioChoice choice) {
    const auto warn = [&](const char* text) { scene.warnings.push_back(name + ": " + text); };
    const Lit lit = light_of(scene, studio_environment(StudioChoice::standard));
    if (lit == Lit::fully) return;
    if (choice == StudioChoice::off) {
        if (lit == Lit::dark) warn("there is no light, and the studio is off: the picture will be black");
        return;
    }
    if (lit == Lit::by_name) {
        warn("only small or dim surfaces emit light; if that is too dark, use --studio default");
        return;
    }
    warn(lit == Lit::dark ? "there is no light; a studio, which the camera does not see, lights the scene"
                          : "only small or dim surfaces emit light; a studio, which the camera does not see, "
                            "lights the scene (--studio off leaves it out)");
    put_into_studio(scene, StudioChoice::standard);
}

// Adds a warning if a scene has no light.
void check_light(Scene& scene, const std::string& name) {
    const bool is_empty = scene.shapes.empty() && !scene.environment;
    if (!is_empty && !has_light(scene))
        scene.warnings.push_back(name + ": the scene has no light: the image will be black");
}

// Only one of the options may replace the environment.
void refuse_two(const LightingOptions& options) {
    std::vector<std::string> given;
    if (options.environment) given.emplace_back("--environment");
    if (options.sky) given.emplace_back("--sky");
    if (options.studio && is_named(*options.studio)) given.emplace_back("--studio");
    if (given.size() > 1)
        throw Error(given[0] + " and " + given[1] + " both light the scene; give one of them",
                    ErrorKind::request);
}

// The environment, or what replaces it.
void choose_light(Scene& scene, const std::string& name, SceneSource source, const LightingOptions& options) {
    const StudioChoice studio = options.studio.value_or(StudioChoice::automatic);
    refuse_two(options);
    if (is_named(studio)) return put_into_studio(scene, studio);
    if (options.sky) {
        scene.environment = sky_environment(*options.sky);
        return;
    }
    if (options.environment) {
        scene.environment =
            load_environment(*options.environment, FileReach(*options.environment), scene.warnings);
        scene.files.push_back(*options.environment);
        return;
    }
    switch (source) {
        case SceneSource::gltf:
            if (!scene.environment) add_studio(scene, name, studio);
            break;
        case SceneSource::mesh:
            if (studio == StudioChoice::off) scene.environment.reset();
            [[fallthrough]];
        case SceneSource::native:
            check_light(scene, name);
    }
}

void scale(Environment& environment, double intensity) {
    for (vec3& radiance : environment.radiance) {
        const dvec3 scaled = intensity * dvec3(radiance);
        if (glm::any(glm::greaterThan(scaled, dvec3(FLOAT_MAX)))) {
            throw Error(
                "--environment-intensity: radiance times intensity exceeds the range of 32-bit floats; lower "
                "the intensity",
                ErrorKind::request);
        }
        radiance = vec3(scaled);
    }
}

}  // namespace

void light_scene(Scene& scene, const std::string& name, SceneSource source, const LightingOptions& options) {
    choose_light(scene, name, source, options);
    make_catchers(scene, name, options.catchers);
    if (!options.rotation && !options.intensity && !options.hidden) return;
    if (!scene.environment) {
        throw Error(
            name + ": the scene has no environment to turn, scale or hide; give one (--environment FILE)",
            ErrorKind::request);
    }
    Environment& environment = *scene.environment;
    if (options.rotation)
        environment.rotation = float(glm::radians(std::remainder(*options.rotation, 360.0)));
    if (options.intensity) scale(environment, *options.intensity);
    if (options.hidden) environment.visible = false;
}

}  // namespace candela
