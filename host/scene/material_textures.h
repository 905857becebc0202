// The textures of materials.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace candela {

// The textures that a material looks up; valid as long as the material is.
std::vector<const Texture*> textures_of(const Material& material);

// The sets of texture coordinates that a surface with these textures must have, a bit each.
uint32_t uv_sets_of(const std::vector<const Texture*>& textures);

}  // namespace candela
