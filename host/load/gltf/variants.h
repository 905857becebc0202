// KHR_materials_variants: a primitive may have other materials under a name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// The variant of that name or index. If the file has no such variant, throws Error (usage) that lists the
// names.
uint32_t find_variant(const File& file, const std::string& name);

// The material that a primitive has in a variant; nothing: its usual one. If there are several, the first is
// used, with a warning.
std::optional<Node> variant_material(File& file, const Node& primitive, uint32_t variant);

}  // namespace candela::gltf
