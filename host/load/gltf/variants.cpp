// See variants.h.
#include "load/gltf/variants.h"

#include "load/gltf/names.h"
#include "load/gltf/values.h"

namespace candela::gltf {

uint32_t find_variant(const File& file, const std::string& name) {
    const auto extension = extension_of(file.root(), "KHR_materials_variants");
    const auto variants = extension ? extension->find("variants") : std::nullopt;
    return uint32_t(find_by_name(file, variants, name, "variants", "--variant"));
}

std::optional<Node> variant_material(File& file, const Node& primitive, uint32_t variant) {
    const auto extension = extension_of(primitive, "KHR_materials_variants");
    const auto mappings = extension ? extension->find("mappings") : std::nullopt;
    if (!mappings) return std::nullopt;
    std::optional<Node> material;
    for (const Node& mapping : mappings->elements()) {
        for (const Node& number : mapping.require("variants").elements()) {
            if (number.integer(0, UINT32_MAX) != variant) continue;
            if (material) {
                file.warn(number, "the variant already has a material, which is used");
            } else {
                material = mapping.require("material");
            }
        }
    }
    return material;
}

}  // namespace candela::gltf
