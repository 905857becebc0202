// See placement.h.
#include "load/gltf/placement.h"

#include <algorithm>
#include <cmath>

namespace candela::gltf {

// The transform, with a little thickness added if it flattens bodies into plane figures, so that their front
// and back do not share a plane. Nothing if it leaves no area.
static std::optional<glm::dmat4> thickened(const glm::dmat4& world) {
    constexpr double THIN = 1e-12;      // As in Transform.
    constexpr double THICKNESS = 1e-5;  // Relative to the longest edge of a cube's image.
    const glm::dmat3 m(world);
    const double longest = std::max({length(m[0]), length(m[1]), length(m[2])});
    // The cofactors of a matrix of rank 2 are the product of the figures' normal and the axis that vanishes.
    const glm::dmat3 cofactor(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    const double size = length(dvec3(length(cofactor[0]), length(cofactor[1]), length(cofactor[2])));
    if (!(size > THIN * longest * longest) || !std::isfinite(size)) return std::nullopt;
    glm::dmat4 result = world;
    for (glm::length_t i = 0; i < 3; ++i)
        result[i] += glm::dvec4(THICKNESS * longest / size * cofactor[i], 0.0);
    return result;
}

std::optional<Transform> transform_of(const glm::dmat4& world) {
    Transform transform;
    if (transform.append(world)) return transform;
    const std::optional<glm::dmat4> thick = thickened(world);
    transform = Transform();
    if (thick && transform.append(*thick)) return transform;
    return std::nullopt;
}

}  // namespace candela::gltf
