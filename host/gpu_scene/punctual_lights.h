// Lights without a surface: records, and the power by which they are chosen.
#pragma once

#include "base/math.h"
#include "gpu_scene/powered_lights.h"
#include "scene/frame.h"
#include "scene/scene.h"

namespace candela {

// The point, spot and directional lights of a scene, in `frame`; not those that are black. A directional
// light has the power that falls onto the scene, as if onto a disk as wide as the sphere around `box`, which
// is the box around all primitives. Throws Error for a light that floats cannot hold in a scene of this size.
// Ref: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, sections 12.2, 12.3 and 12.5.
PoweredLights build_punctual_lights(const Scene& scene, const SceneFrame& frame, const Box& box);

// Whether the light is infinitely far away, but not the sky.
inline bool is_afar(const LightRecord& light) {
    return light.kind == LIGHT_DIRECTIONAL || light.kind == LIGHT_SUN;
}

// Luminance of the irradiance of such a light on a surface perpendicular to it [W/m^2].
double irradiance_across(const LightRecord& light);

}  // namespace candela
