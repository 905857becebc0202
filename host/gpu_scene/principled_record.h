// The principled material -> its records.
#pragma once

#include <utility>
#include <vector>

#include "gpu_scene/material_record.h"

namespace candela {

// The index of refraction that the records hold: finite where the material's is 0, which means that all light
// is reflected.
float principled_ior(const PrincipledMaterial& m);

EncodedPrincipled encode_principled(const PrincipledMaterial& m);

// The images of a material's values: textures that differ only in the channel are one.
std::vector<std::pair<Texture, PrincipledImage>> principled_images(
    const std::vector<PrincipledTexture>& textures);

// Fraction of diffuse light that a smooth dielectric of that index, at least 1, reflects from below: 1 - (1 -
// E) / n^2, where E is the fraction from above. Ref: Walsh 1926, The Reflection Factor of a Polished Glass
// Surface for Diffused Light.
double internal_reflectance(double n);

}  // namespace candela
