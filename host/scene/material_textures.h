// The textures of materials.
#pragma once

#include <type_traits>
#include <variant>

#include "scene/scene.h"

namespace candela {

// Calls visit(value) for each value of a model, constant or not, that a texture may give.
template <class Model, class Visit>
void for_each_value(Model& m, const Visit& visit) {
    using Type = std::remove_const_t<Model>;
    if constexpr (std::is_same_v<Type, DiffuseMaterial> || std::is_same_v<Type, MirrorMaterial>) {
        visit(m.reflectance);
    } else if constexpr (std::is_same_v<Type, PhongMaterial>) {
        visit(m.diffuse), visit(m.specular), visit(m.exponent);
    } else if constexpr (std::is_same_v<Type, ConductorMaterial>) {
        visit(m.reflectance), visit(m.alpha);
    } else if constexpr (std::is_same_v<Type, DiffuseTransmissionMaterial>) {
        visit(m.reflectance), visit(m.transmittance);
    } else if constexpr (std::is_same_v<Type, PrincipledMaterial>) {
        const auto visit_textured = [&](auto& value) {
            if constexpr (requires { value.factor; }) visit(value);
        };
#define VALUE(kind, name, initial, min, max, needs, text) visit_textured(m.name);
#define KEY(name, member, text)
#include "scene/principled_values.inc"
#undef VALUE
#undef KEY
    } else {
        static_assert(std::is_same_v<Type, DielectricMaterial> || std::is_same_v<Type, InterfaceMaterial>);
    }
}

// Calls visit(texture) for each texture that a material, constant or not, looks up.
template <class SomeMaterial, class Visit>
void for_each_texture(SomeMaterial& material, const Visit& visit) {
    const auto texture_of = [&](auto& value) {
        if (value.texture) visit(*value.texture);
    };
    std::visit([&](auto& model) { for_each_value(model, texture_of); }, material.model);
    if (auto* principled = std::get_if<PrincipledMaterial>(&material.model)) {
        if (principled->anisotropy_map) visit(*principled->anisotropy_map);
        if (principled->coat_normal_map) visit(principled->coat_normal_map->texture);
    }
    texture_of(material.opacity.value);
    if (material.normal_map) visit(material.normal_map->texture);
    if (material.bump_map) visit(material.bump_map->texture);
}

}  // namespace candela
