// See studio.h, and add_studio() in gltf.h.
#include "load/gltf/studio.h"

#include <algorithm>
#include <string>

#include "load/gltf/gltf.h"
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

}  // namespace

void add_studio(Scene& scene, const std::string& name, std::optional<StudioChoice> choice) {
    const auto warn = [&](const char* text) { scene.warnings.push_back(name + ": " + text); };
    if (choice == StudioChoice::standard) {
        scene.environment = gltf::studio();
        return;
    }
    if (scene.environment) return;
    Environment studio = gltf::studio();
    const Lit lit = light_of(scene, studio);
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
    scene.environment = std::move(studio);
}

namespace gltf {

Environment studio() {
    constexpr uvec2 SIZE{128, 64};
    struct Box {
        dvec3 towards;    // Its middle.
        double half;      // Cosine of the angle to its edge.
        double radiance;  // [W/(m^2 sr)]
    };
    const Box boxes[] = {{normalize(dvec3(-0.6, 0.9, 0.6)), 0.85, 2.5},
                         {normalize(dvec3(1.0, 0.35, 0.5)), 0.9, 0.85},
                         {normalize(dvec3(0.2, 0.6, -1.0)), 0.93, 1.25}};
    constexpr double SOFTNESS = 0.03;  // Softness of edges, in cosines.
    Environment environment{.size = SIZE, .radiance = {}, .visible = false};
    for (uint32_t y = 0; y < SIZE.y; ++y) {
        for (uint32_t x = 0; x < SIZE.x; ++x) {
            const dvec3 w = latitude_longitude_direction({(x + 0.5) / SIZE.x, (y + 0.5) / SIZE.y});
            double radiance =
                w.y < 0.0 ? 0.15 + 0.06 * -w.y : 0.15 + 0.15 * w.y;  // Floor; walls and ceiling.
            for (const Box& box : boxes)
                radiance += box.radiance *
                            glm::smoothstep(box.half - SOFTNESS, box.half + SOFTNESS, dot(w, box.towards));
            environment.radiance.emplace_back(float(radiance));
        }
    }
    return environment;
}

}  // namespace gltf
}  // namespace candela
