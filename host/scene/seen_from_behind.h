// Single-sided surfaces that a camera sees from behind, where they are invisible.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace candela {

// Makes all materials double-sided, with the emission of their shapes.
void make_double_sided(Scene& scene);

// The share of a picture of that size in which the first surface is single-sided (is_culled()) and seen from
// behind, by a grid of at most 128 x 128 rays without a lens. Masks and opacity are ignored, and so are
// spheres and disks. Nothing if the scene has no such material, or more than 2^22 triangles, instances
// included, or if the camera sees to all sides.
std::optional<double> share_seen_from_behind(const Scene& scene, const Camera& camera, uvec2 size);

}  // namespace candela
