// Values of a glTF file with a range: values outside are clamped, with a warning.
#pragma once

#include <optional>
#include <string_view>

#include "base/math.h"
#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// The most that a light's intensity, or a factor of emission, may be: its products fit into floats.
inline constexpr float MAX_LIGHT = 1e30f;

// The number of a key, in [lo, hi]; `otherwise` if the key is absent.
float number_of(File& file, const Node& object, std::string_view key, float lo, float hi, float otherwise);

// The same for three numbers.
vec3 color_of(File& file, const Node& object, std::string_view key, float hi, vec3 otherwise);

// The position to which a node's matrix moves its origin. Throws Error at `place` if it lies too far away.
dvec3 position_of(const Node& place, const glm::dmat4& world);

// Whether a vector is not zero, and its length does not overflow.
bool has_direction(dvec3 v);

// The extension of that name that an element has.
std::optional<Node> extension_of(const Node& element, std::string_view name);

}  // namespace candela::gltf
