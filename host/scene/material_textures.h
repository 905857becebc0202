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
        visit(m.base_color), visit(m.metalness), visit(m.roughness), visit(m.diffuse_roughness);
        visit(m.specular), visit(m.specular_color), visit(m.anisotropy), visit(m.transmission);
        visit(m.diffuse_transmission), visit(m.diffuse_transmission_color);
        visit(m.coat), visit(m.coat_roughness), visit(m.sheen_color), visit(m.sheen_roughness);
        visit(m.fuzz), visit(m.fuzz_color), visit(m.fuzz_roughness);
        visit(m.iridescence), visit(m.iridescence_thickness), visit(m.emission);
    } else {
        static_assert(std::is_same_v<Type, DielectricMaterial>);
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
