// The camera: pixels to rays.
#ifndef SCENE_CAMERA_GLSL
#define SCENE_CAMERA_GLSL

#include "base/ray.glsl"
#include "shared/parameters.h"

// The ray through a film position in pixels of the whole picture: origin top left, y downwards. Unit direction.
Ray camera_ray(Parameters camera, vec2 film) {
    vec2 s = 2.0 * film / vec2(camera.full_size) - 1.0;
    return Ray(camera.position, normalize(camera.forward + s.x * camera.right - s.y * camera.up));
}

#endif
