// The media at a point.
#pragma once

#include "gpu_scene/gpu_scene.h"

namespace candela {

// The media around a point of the world, as shaders/medium/medium.glsl packs them: if priorities are equal,
// the one whose surface is nearest along a ray comes first, as if it had been entered last. Zero if there are
// none. At most MEDIA_AT_ONCE; others are left out.
//
// A point is within a solid if a ray from there leaves it more often than it enters it. So a surface that
// encloses a medium must be closed; with a single sheet, such as the surface of a lake, everything from which
// the ray meets its back is inside.
uvec2 media_at(const GpuScene& scene, dvec3 point);

}  // namespace candela
