// The space in which the records of a scene are made: see scene/frame.h.
#pragma once

#include "scene/frame.h"
#include "scene/scene.h"

namespace candela {

// The frame for a scene: its origin is the centre of the box around all shapes, its unit the least power of
// two that is greater than the box's longest side. It depends on no camera.
SceneFrame choose_frame(const Scene& scene);

// The same for a box, and for a mesh in its own space.
SceneFrame frame_around(const DoubleBox& box);
SceneFrame frame_around(const TriangleMesh& mesh);

}  // namespace candela
