// Questions about a material.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace candela {

// The emission of shapes of this material that do not state their own.
std::optional<Emission> material_emission(const Material& material);

// Whether rays pass surfaces of this material from behind.
bool is_culled(const Material& material);

// Whether the surface shows its colour in any light.
bool is_unlit(const Material& material);

// Whether the light of a surface depends on its tangents: under normal maps, and where reflection is not the
// same in all directions.
bool needs_tangents(const Material& material);

// The set of texture coordinates, 0 or 1, along which the tangents of a mesh run: the set of the first of
// these that the material has: its normal map, the coat's, and the texture of anisotropy. Only if
// needs_tangents().
uint32_t tangent_uv_set(const Material& material);

}  // namespace candela
