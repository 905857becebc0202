// Lights without a surface: records, and the power by which they are chosen.
#pragma once

#include "base/math.h"
#include "gpu_scene/flatten.h"

namespace candela {

// Adds the point, spot and directional lights of a scene to those of its shapes, in `frame`; not those that
// are black. A directional light has the power that falls onto the scene, as if onto a disk as wide as the
// sphere around `box`, which is the box around all primitives. Throws Error for a light that floats cannot
// hold in a scene of this size.
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, sections 12.2, 12.3 and 12.5.
void add_punctual_lights(FlatScene& flat, const Scene& scene, const SceneFrame& frame, const Box& box);

}  // namespace candela
