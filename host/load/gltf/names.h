// Elements of a glTF file by their names.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "load/gltf/gltf_file.h"

namespace candela::gltf {

// The name of an element; `otherwise` if it has none.
std::string name_of(const Node& element, const std::string& otherwise);

// The element of `array`, which may be missing, that has this name or index. If there is none, throws Error
// (usage) that begins with `option` and lists the names; `what` is what messages call the elements.
size_t find_by_name(const File& file, const std::optional<Node>& array, const std::string& name,
                    std::string_view what, const char* option);

}  // namespace candela::gltf
