// How much the surfaces of a scene that emit light it.
#pragma once

#include "scene/scene.h"

namespace candela {

struct Glow {
    // The mean radiance of what surfaces emit, over all points in the sphere around the scene's bounds and
    // all directions, if nothing stood in its way [W/(m^2 sr)]. So a surface that faces outwards gives
    // little.
    double radiance = 0.0;
    double area = 0.0;         // Of the surfaces that are as bright as asked for: a fraction of all.
    bool above_white = false;  // Whether a surface emits more than 1 of some colour.
};

// Looks at meshes that emit, at some triangles in place of all if there are many. `bright` is the least
// radiance of a bright surface. The images must have been read.
Glow glow_of(const Scene& scene, double bright);

// The mean radiance of an environment over all directions.
double mean_radiance(const Environment& environment);

}  // namespace candela
