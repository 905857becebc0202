// Ref: Khronos, KHR_lights_punctual.
#include "load/gltf/light.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "base/text.h"
#include "load/gltf/names.h"
#include "load/gltf/values.h"

namespace candela::gltf {
namespace {

constexpr float HALF_PI = PI / 2;
// Blender writes watts as lumens of light with 683 lm/W.
constexpr double LUMENS_PER_WATT = 683.0;

// The intensity [W/sr] for a file's intensity [cd].
double intensity_factor(LightUnits units) {
    switch (units) {
        case LightUnits::spec:
            return 1.0;
        case LightUnits::blender:
            return 1.0 / LUMENS_PER_WATT;
        case LightUnits::raw:
            break;  // Watts, to all directions.
    }
    return 1.0 / (4.0 * double(PI));
}

// The irradiance [W/m^2] for a file's illuminance [lx].
double illuminance_factor(LightUnits units) {
    return units == LightUnits::blender ? 1.0 / LUMENS_PER_WATT : 1.0;
}

Node lights_of(const File& file, const Node& reference) {
    const auto extension = extension_of(file.root(), "KHR_lights_punctual");
    const auto lights = extension ? extension->find("lights") : std::nullopt;
    if (!lights) reference.fail("the file has no lights; export it again");
    return *lights;
}

Cone read_cone(File& file, const Node& light) {
    constexpr float MIN_EDGE = 1e-4f;  // [rad]: between the angles, so that the edge has a width.
    const auto spot = light.find("spot");
    const float inner = spot ? number_of(file, *spot, "innerConeAngle", 0.0f, HALF_PI, 0.0f) : 0.0f;
    const float outer = spot ? number_of(file, *spot, "outerConeAngle", 0.0f, HALF_PI, PI / 4) : PI / 4;
    if (inner > outer)
        file.warn(*spot, "the inner angle of a spot is greater than the outer one, and is treated as equal");
    Cone cone;
    cone.outer_angle = std::max(outer, 2.0f * MIN_EDGE);
    cone.inner_angle = std::min(inner, cone.outer_angle - MIN_EDGE);
    return cone;
}

}  // namespace

LightUnits units_of(const File& file, const GltfOptions& options) {
    if (options.light_units) return *options.light_units;
    const auto generator = file.root().require("asset").find("generator");
    const std::string name = generator && generator->is_string() ? generator->string() : "";
    if (name.find("Blender") == std::string::npos) return LightUnits::spec;
    // "Khronos glTF Blender I/O v3.3.27". Before 3.4, it wrote its own watts. The first exporters, "Khronos
    // Blender glTF 2.0 I/O" and the like, state no version.
    if (name.starts_with("Khronos Blender glTF 2.0")) return LightUnits::raw;
    int major = INT_MAX, minor = 0;
    const size_t version = name.find("I/O v");
    if (version != std::string::npos) std::sscanf(name.c_str() + version, "I/O v%d.%d", &major, &minor);
    return std::pair(major, minor) < std::pair(3, 4) ? LightUnits::raw : LightUnits::blender;
}

Light read_light(File& file, const Node& reference, const glm::dmat4& world, LightUnits units) {
    const Node lights = lights_of(file, reference);
    const uint32_t index = reference.integer(0, UINT32_MAX);
    if (index >= lights.size()) reference.fail(concat("there is no light ", index, " among ", lights.size()));
    const Node light = lights[index];
    const vec3 color = color_of(file, light, "color", 1.0f, vec3(1.0f));
    const double intensity = double(number_of(file, light, "intensity", 0.0f, MAX_LIGHT, 1.0f));
    if (const auto range = light.find("range"))
        file.warn(*range, "the range of a light is ignored: its intensity falls with the squared distance");
    const dvec3 position = position_of(reference, world);
    const dvec3 axis = dvec3(-world[2]);
    const dvec3 direction = has_direction(axis) ? normalize(axis) : dvec3(0, 0, -1);
    const vec3 power(intensity_factor(units) * intensity * dvec3(color));

    const Node type_node = light.require("type");
    const std::string& type = type_node.string();
    Light result{.name = name_of(light, concat("light ", index)), .model = PointLight{position, power}};
    if (type == "directional") {
        result.model =
            DirectionalLight{direction, vec3(illuminance_factor(units) * intensity * dvec3(color))};
    } else if (type == "spot") {
        result.model = SpotLight{position, direction, power, read_cone(file, light)};
    } else if (type != "point") {
        type_node.fail_expected(R"("point", "spot" or "directional")");
    }
    return result;
}

}  // namespace candela::gltf
