// Shifted lenses, in the convention of Blender.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/scene.h"

namespace candela {

// What errors say of a shift that is too large.
inline constexpr const char* SHIFT_TOO_LARGE =
    "the shift is more than 1000 heights of the picture; it is in its longer sides, such as 0.1";

// The principal point off the middle, as Camera has it, of a picture of `size` that shows what is `shift`
// farther to the right and upwards, in longer sides of the picture; none if that is too far.
inline std::optional<vec2> shifted_offset(glm::dvec2 shift, uvec2 size) {
    const vec2 offset(glm::dvec2(-shift.x, shift.y) * (double(std::max(size.x, size.y)) / size.y));
    if (!(std::max(std::abs(offset.x), std::abs(offset.y)) <= MAX_PRINCIPAL_OFFSET)) return std::nullopt;
    return offset + 0.0f;  // Without "-0".
}

}  // namespace candela
