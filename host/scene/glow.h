// How strongly the emitting surfaces of a scene light it.
#pragma once

#include "scene/scene.h"

namespace candela {

struct Glow {
    // The mean radiance from emitting surfaces, over all points in the sphere around the scene's bounds and
    // all directions, if nothing blocked it [W/(m^2 sr)]. So a surface that faces outwards contributes
    // little.
    double radiance = 0.0;
    double area = 0.0;         // Area of the bright surfaces, as a fraction of all.
    bool above_white = false;  // Whether a surface emits more than 1 of some colour.
};

// Looks at meshes that emit, at only some of their triangles if there are many. `bright` is the least
// radiance of a bright surface. The images must have been read.
Glow glow_of(const Scene& scene, double bright);

// The mean radiance of an environment over all directions.
double mean_radiance(const Environment& environment);

}  // namespace candela
