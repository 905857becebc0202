// KHR_materials_variants: a primitive may have other materials under a name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// The variant of that name or index. Throws Error (usage) that lists the names if the file has none such.
uint32_t find_variant(const File& file, const std::string& name);

// The material that a primitive has in a variant; nothing: the one that it always has. Of several, the first
// counts, with a warning.
std::optional<Node> variant_material(File& file, const Node& primitive, uint32_t variant);

}  // namespace candela::gltf
