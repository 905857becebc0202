// Materials and media -> records.
#pragma once

#include "scene/scene.h"
#include "shared/material.h"

namespace candela {

// What a material's record holds, and the textures by which some of that is multiplied.
struct EncodedMaterial {
    MaterialRecord record{};
    std::optional<Texture> base{}, specular{}, parameter{};  // As in MaterialTextures.
};

// `medium` is the index of medium_behind() among the records of media; it does not matter for an opaque
// material.
EncodedMaterial encode_material(const decltype(Material::model)& model, uint32_t medium = MEDIUM_NONE);

// The medium behind a surface; none if it is the same as in front, or if the material is opaque.
std::optional<Medium> medium_behind(const decltype(Material::model)& model);

}  // namespace candela
