// A default camera and default light.
#pragma once

#include "scene/scene.h"

namespace candela {

// Adds a camera, named "default", that looks at all shapes from the front, slightly from the right and from
// above: the sphere around their bounds touches the picture's upper and lower edge.
void add_default_camera(Scene& scene);

// Adds that camera and, if nothing emits, a constant sky of radiance 1, for files that have neither.
void add_default_view(Scene& scene);

}  // namespace candela
