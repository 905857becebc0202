// See values.h.
#include "load/gltf/values.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace candela::gltf {
namespace {

float limited(File& file, const Node& node, double value, float lo, float hi) {
    if (float(value) >= lo && float(value) <= hi) return float(value);
    const double nearest = std::clamp(value, double(lo), double(hi));
    file.warn(node, concat(number_text(value, 9), " is not between ", number_text(double(lo), 6), " and ",
                           number_text(double(hi), 6), "; it is read as ", number_text(nearest, 6)));
    return float(nearest);
}

}  // namespace

float number_of(File& file, const Node& object, std::string_view key, float lo, float hi, float otherwise) {
    const auto node = object.find(key);
    return node ? limited(file, *node, node->number(), lo, hi) : otherwise;
}

vec3 color_of(File& file, const Node& object, std::string_view key, float hi, vec3 otherwise) {
    const auto node = object.find(key);
    if (!node) return otherwise;
    const dvec3 color = node->vector();
    vec3 result;
    for (glm::length_t i = 0; i < 3; ++i)
        result[i] = limited(file, *node, color[i], 0.0f, hi);
    return result;
}

dvec3 position_of(const Node& place, const glm::dmat4& world) {
    const dvec3 position(world[3]);
    if (!all(lessThanEqual(abs(position), dvec3(double(MAX_COORDINATE)))))
        place.fail("it lies beyond 1e37 along an axis; check the transforms of the nodes around it");
    return position;
}

bool has_direction(dvec3 v) {
    const double size = length(v);
    return size > 0.0 && std::isfinite(size);
}

std::optional<Node> extension_of(const Node& element, std::string_view name) {
    const auto extensions = element.find("extensions");
    return extensions ? extensions->find(name) : std::nullopt;
}

}  // namespace candela::gltf
