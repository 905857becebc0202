// Values of a glTF file that a range limits: what lies outside is clamped, with a warning.
#pragma once

#include <optional>
#include <string_view>

#include "base/math.h"
#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// The number of a key, in [lo, hi]; `otherwise` if the key is absent.
float number_of(File& file, const Node& object, std::string_view key, float lo, float hi, float otherwise);

// The same for three numbers.
vec3 color_of(File& file, const Node& object, std::string_view key, float hi, vec3 otherwise);

// The extension of that name that an element has.
std::optional<Node> extension_of(const Node& element, std::string_view name);

}  // namespace candela::gltf
