// The camera: pixels to rays.
#ifndef SCENE_CAMERA_GLSL
#define SCENE_CAMERA_GLSL

#include "base/pixel_filter.glsl"
#include "base/ray.glsl"
#include "base/sampler.glsl"
#include "base/warp.glsl"
#include "shared/kernel_constants.h"
#include "shared/parameters.h"

// Whether the camera has a lens of some size, is sharp all around, or sees within a circle alone.
const bool HAS_LENS = CAMERA == CAMERA_DISK || CAMERA == CAMERA_POLYGON;
const bool IS_PANORAMA = CAMERA >= CAMERA_EQUIRECTANGULAR;
const bool IS_FISHEYE = CAMERA >= CAMERA_FISHEYE;

// A film position, in pixels of the whole picture (origin top left, y downwards), relative to the principal point in
// halves of the picture's width and height.
vec2 camera_film_place(Parameters camera, vec2 film) {
    return 2.0 * film / vec2(camera.full_size) - camera.principal_point;
}

// Direction of the pinhole ray through a film position. Its length along the camera's axis is 1.
vec3 camera_film_direction(Parameters camera, vec2 film) {
    vec2 s = camera_film_place(camera, film);
    return camera.forward + s.x * camera.right - s.y * camera.up;
}

// The ray of an orthographic camera through a film position. Unit direction.
Ray camera_ray_parallel(Parameters camera, vec2 film) {
    vec2 s = camera_film_place(camera, film);
    return Ray(camera.position + s.x * camera.right - s.y * camera.up, camera.forward);
}

// A film position relative to the centre of a fisheye's circle, whose radius is 1; in world space.
vec3 camera_circle_place(Parameters camera, vec2 film) {
    vec2 s = camera_film_place(camera, film);
    return s.x * camera.right - s.y * camera.up;
}

// Whether the camera sees anything at a film position: a fisheye does not outside of its circle.
bool camera_sees(Parameters camera, vec2 film) {
    if (!IS_FISHEYE) return true;
    vec3 place = camera_circle_place(camera, film);
    return dot(place, place) <= 1.0;
}

// Direction in which an equirectangular camera or a fisheye sees a film position; unit length. Beyond a pole, an
// equirectangular picture goes on on the other side; beyond its circle, a fisheye has the direction of the edge.
vec3 camera_panorama_direction(Parameters camera, vec2 film) {
    if (CAMERA == CAMERA_EQUIRECTANGULAR) {
        vec2 s = camera_film_place(camera, film);
        vec2 longitude = cos_sin_turn(fract(0.5 * s.x)), latitude = cos_sin_turn(fract(-0.25 * s.y));
        vec3 level = longitude.x * camera.forward + longitude.y * camera.right;
        return latitude.x * level + latitude.y * camera.up;
    }
    vec3 place = camera_circle_place(camera, film);
    float r = length(place);
    if (r > 1.0) place /= r;
    r = min(r, 1.0);
    if (CAMERA == CAMERA_FISHEYE) {
        vec2 cos_sin = cos_sin_turn(r * camera.fisheye_edge);
        return cos_sin.x * camera.forward + (cos_sin.y / max(r, 1e-20)) * place;
    }
    float sin_half = r * camera.fisheye_edge;
    float cos_half = sqrt(max(0.0, 1.0 - square(sin_half)));
    return (1.0 - 2.0 * square(sin_half)) * camera.forward + (2.0 * cos_half * camera.fisheye_edge) * place;
}

// The ray through a film position and the centre of the aperture. Unit direction.
Ray camera_ray_sharp(Parameters camera, vec2 film) {
    if (CAMERA == CAMERA_ORTHOGRAPHIC) return camera_ray_parallel(camera, film);
    if (IS_PANORAMA) return Ray(camera.position, camera_panorama_direction(camera, film));
    return Ray(camera.position, normalize(camera_film_direction(camera, film)));
}

// The ray through a film position and a point of the aperture, which u in [0,1)^2 chooses uniformly by area. All rays
// of one film position meet in the plane of focus. Unit direction.
// Ref: Cook, Porter and Carpenter 1984, Distributed Ray Tracing, section 2.
Ray camera_ray(Parameters camera, vec2 film, vec2 u) {
    if (!HAS_LENS) return camera_ray_sharp(camera, film);
    vec2 aperture = CAMERA == CAMERA_DISK ? warp_disk(u) : warp_polygon(u, camera.blades);
    vec3 offset = aperture.x * camera.lens_x + aperture.y * camera.lens_y;
    vec3 to_focus = camera_film_direction(camera, film) - offset / camera.focal_distance;
    return Ray(camera.position + offset, normalize(to_focus));
}

// What a sample of a pixel sees.
struct CameraSample {
    Ray ray;
    bool sees;  // False where the camera does not see anything.
};

// The sample of that pixel of the whole picture.
CameraSample camera_sample(Parameters camera, uvec2 pixel, Sampler random) {
    vec2 film = filter_film_position(pixel, unit_float(sampler_pair(random, PAIR_PIXEL)));
    return CameraSample(camera_ray(camera, film, unit_float(sampler_pair(random, PAIR_LENS))),
                        camera_sees(camera, film));
}

#endif
