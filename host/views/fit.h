// Cameras that see all of some bodies, as close as possible.
#pragma once

#include <span>

#include "scene/camera_axes.h"
#include "views/bodies.h"

namespace candela {

// The place from which a camera with these axes sees all bodies within the given tangents of half its angles,
// along x and y, and they touch the edges on both sides along one of the two. Along the other they are in the
// middle.
dvec3 fitted_position(std::span<const Body> bodies, const CameraAxes& axes, glm::dvec2 tangents);

}  // namespace candela
