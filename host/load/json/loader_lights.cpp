// Lights without a surface: point, spot and directional; and the cones in which spots and spheres emit.
#include <algorithm>
#include <cmath>

#include "load/json/loader_parts.h"
#include "scene/geometry.h"
#include "scene/names.h"

namespace candela {
namespace {

PointLight read_point(const Node& node) {
    node.allow_only({"type"}, keys_of({"light", "point"}));
    return {.position = node.require("position").vector(),
            .intensity = vec3(node.require("intensity").rgb())};
}

// The axis of a spot light at `position`.
dvec3 spot_direction(const Node& node, dvec3 position) {
    const auto direction = node.find("direction");
    const auto look_at = node.find("look_at");
    if (direction.has_value() == look_at.has_value())
        node.fail(R"(a spot light needs either "direction", or "look_at", a point on its axis)");
    if (direction) return direction_of(*direction);
    const dvec3 target = look_at->vector();
    if (target == position) look_at->fail("the light looks at its own position; move one of the two");
    return target - position;
}

SpotLight read_spot(const Node& node) {
    node.allow_only({"type"}, keys_of({"light", "spot"}));
    SpotLight light;
    light.position = node.require("position").vector();
    light.direction = spot_direction(node, light.position);
    light.intensity = vec3(node.require("intensity").rgb());
    light.cone = read_cone(node);
    return light;
}

DirectionalLight read_directional(const Node& node) {
    node.allow_only({"type"}, keys_of({"light", "directional"}));
    DirectionalLight light{.direction = direction_of(node.require("direction")),
                           .irradiance = vec3(node.require("irradiance").rgb())};
    if (const auto angle = node.find("angle")) {
        const double degrees = angle->non_negative();
        if (degrees >= 180.0) angle->fail_expected("an angle below 180 degrees");
        light.angle = float(glm::radians(degrees));
    }
    return light;
}

}  // namespace

dvec3 direction_of(const Node& node) {
    const dvec3 direction = node.vector();
    if (direction == dvec3(0.0)) node.fail_expected("a direction, not zero");
    return direction;
}

Cone read_cone(const Node& node) {
    constexpr double WIDEST = 90.0;
    Cone cone;
    const auto inner = node.find("inner_angle");
    const auto outer = node.find("outer_angle");
    const double outer_degrees = outer ? outer->number() : glm::degrees(double(cone.outer_angle));
    if (!(outer_degrees > 0.0 && outer_degrees <= WIDEST))
        outer->fail_expected("an angle above 0 and of at most 90 degrees");
    cone.outer_angle = float(glm::radians(outer_degrees));
    if (inner) {
        const double degrees = inner->non_negative();
        cone.inner_angle = float(glm::radians(degrees));
        if (!(degrees < outer_degrees && cone.inner_angle < cone.outer_angle))
            inner->fail("inner_angle must be below outer_angle, which is " + number_text(outer_degrees, 6) +
                        " degrees");
    }
    if (const auto falloff = node.find("falloff")) cone.falloff = falloff->choice(FALLOFF_NAMES);
    return cone;
}

std::vector<Light> read_lights(const Node& node, Scene& scene) {
    using Model = decltype(Light::model);
    constexpr std::array<std::pair<std::string_view, Model (*)(const Node&)>, 3> READERS{
        {{"point", [](const Node& light) -> Model { return read_point(light); }},
         {"spot", [](const Node& light) -> Model { return read_spot(light); }},
         {"directional", [](const Node& light) -> Model { return read_directional(light); }}}};
    std::vector<Light> lights;
    for (const Node& element : node.elements()) {
        const Node type = element.require("type");
        Light light{.name = {}, .model = type.choice(READERS)(element)};
        const auto name = element.find("name");
        light.name = name ? name->string() : type.string() + ' ' + std::to_string(lights.size() + 1);
        if (!gives_light(light)) {
            scene.warnings.push_back(element.place() + ": the light \"" + light.name +
                                     "\" is black: it gives no light");
        }
        lights.push_back(std::move(light));
    }
    return lights;
}

}  // namespace candela
