// Which media are at a point.
#pragma once

#include "gpu_scene/gpu_scene.h"

namespace candela {

// The media around a point of the world, as shaders/medium/medium.glsl packs them: of those of equal
// priority, the one whose surface is nearest along a ray comes first, as if it had been entered last. Zero if
// there are none. At most MEDIA_AT_ONCE; others are left out.
//
// A point is within a solid if a ray from there leaves it more often than it enters it. So what encloses a
// medium must be closed; of a single sheet, such as the surface of a lake, all that the ray reaches from
// behind is inside.
uvec2 media_at(const GpuScene& scene, dvec3 point);

}  // namespace candela
