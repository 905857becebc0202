// The camera: pixels to rays.
#ifndef SCENE_CAMERA_GLSL
#define SCENE_CAMERA_GLSL

#include "base/ray.glsl"
#include "base/warp.glsl"
#include "shared/kernel_constants.h"
#include "shared/parameters.h"

// Direction of the pinhole ray through a film position in pixels of the whole picture: origin top left, y downwards.
// Its length along the camera's axis is 1.
vec3 camera_film_direction(Parameters camera, vec2 film) {
    vec2 s = 2.0 * film / vec2(camera.full_size) - camera.principal_point;
    return camera.forward + s.x * camera.right - s.y * camera.up;
}

// The ray of an orthographic camera through a film position. Unit direction.
Ray camera_ray_parallel(Parameters camera, vec2 film) {
    vec2 s = 2.0 * film / vec2(camera.full_size) - camera.principal_point;
    return Ray(camera.position + s.x * camera.right - s.y * camera.up, camera.forward);
}

// The ray through a film position and the centre of the aperture. Unit direction.
Ray camera_ray_sharp(Parameters camera, vec2 film) {
    if (CAMERA == CAMERA_ORTHOGRAPHIC) return camera_ray_parallel(camera, film);
    return Ray(camera.position, normalize(camera_film_direction(camera, film)));
}

// The ray through a film position and a point of the aperture, which u in [0,1)^2 chooses uniformly by area. All rays
// of one film position meet in the plane of focus. Unit direction.
// Ref: Cook, Porter and Carpenter 1984, Distributed Ray Tracing, section 2.
Ray camera_ray(Parameters camera, vec2 film, vec2 u) {
    if (CAMERA == CAMERA_PINHOLE || CAMERA == CAMERA_ORTHOGRAPHIC) return camera_ray_sharp(camera, film);
    vec2 aperture = CAMERA == CAMERA_DISK ? warp_disk(u) : warp_polygon(u, camera.blades);
    vec3 offset = aperture.x * camera.lens_x + aperture.y * camera.lens_y;
    vec3 to_focus = camera_film_direction(camera, film) - offset / camera.focal_distance;
    return Ray(camera.position + offset, normalize(to_focus));
}

#endif
