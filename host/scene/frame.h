// The space in which a scene's records are made.
#pragma once

#include "base/math.h"

namespace candela {

// The point p of the user's world lies at (p - origin) / unit. Floats are finest around 0 and too coarse for
// scenes far from it, so a frame has its origin in the middle of the scene, and a unit of about its size.
struct SceneFrame {
    dvec3 origin{0.0};
    double unit = 1.0;  // [m], a power of two: multiplying by it is exact.

    bool operator==(const SceneFrame&) const = default;

    // A point of the world in the frame, rounded once; and a difference of two points, or a length.
    vec3 point(dvec3 p) const { return vec3((p - origin) / unit); }
    vec3 vector(dvec3 v) const { return vec3(v / unit); }
    float length(double l) const { return float(l / unit); }
    // A point of the frame in the world.
    dvec3 world(vec3 p) const { return origin + unit * dvec3(p); }
};

}  // namespace candela
