// Materials and media -> records.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/material.h"
#include "shared/principled.h"

namespace candela {

// A value of a principled material that an image gives: its bit in PrincipledImage::values.
struct PrincipledTexture {
    uint32_t value = 0;
    Texture texture{};
};

// The part of a principled material that is not in its MaterialRecord.
struct EncodedPrincipled {
    PrincipledRecord record{};  // Neither `images` nor `coat_normal` is set.
    uint32_t parts = 0;         // Bits PRINCIPLED_HAS_*.
    std::vector<PrincipledTexture> textures{};
    std::optional<Texture> coat_normal{};
};

// The contents of a material's record, and the textures that multiply some of its values.
struct EncodedMaterial {
    MaterialRecord record{};
    std::optional<Texture> base{}, specular{}, parameter{};  // As in MaterialTextures.
    std::optional<EncodedPrincipled> principled{};           // Only if the model is MATERIAL_PRINCIPLED.
};

// The medium that a surface encloses.
struct Interior {
    Medium medium{};
    float ior = 1.0f;
    uint32_t priority = 0;  // At most MAX_PRIORITY.

    bool operator==(const Interior&) const = default;
};

// `medium` identifies interior() in shared/medium.h; it does not matter for an opaque material.
EncodedMaterial encode_material(const decltype(Material::model)& model, uint32_t medium = MEDIUM_NONE);

// The medium behind a surface; none if it is the same as in front, or if the material is opaque.
std::optional<Interior> interior(const decltype(Material::model)& model);

}  // namespace candela
