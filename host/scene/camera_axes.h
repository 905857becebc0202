// The axes of a camera, in double precision.
#pragma once

#include "scene/scene.h"

namespace candela {

// Unit vectors at right angles to each other.
struct CameraAxes {
    dvec3 right, up, forward;
};

inline CameraAxes axes_of(const Camera& camera) {
    const dvec3 forward = normalize(camera.look_at - camera.position);
    const dvec3 right = normalize(cross(forward, dvec3(camera.up)));
    return {right, cross(right, forward), forward};
}

}  // namespace candela
