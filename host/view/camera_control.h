// Moves a camera by hand: orbit, pan, dolly and fly. Pure functions of a camera, which orbits the point that
// it looks at.
#pragma once

#include <string>

#include "base/math.h"
#include "scene/scene.h"

namespace candela {

// Moves the camera on the sphere around the point that it looks at: by `azimuth` [rad] about `up`, so that
// positive values turn the scene to the right, and by `elevation` [rad] upwards, stopping short of the poles.
void orbit(Camera& camera, float azimuth, float elevation);

// Moves the camera and the point that it looks at across its view, so that the scene there moves in the
// picture by `shift`, x to the right, y up, in heights of the picture.
void pan(Camera& camera, vec2 shift);

// Moves the camera to `factor` (above 0) times its distance from the point that it looks at; an orthographic
// camera sees `factor` times as much from the same place.
void dolly(Camera& camera, float factor);

// Moves the camera and the point that it looks at by `shift`: to the right, up, forwards, in the camera's
// frame [m].
void fly(Camera& camera, dvec3 shift);

// {"cameras": {NAME: {...}}}: the camera in the syntax of scene files, angles in degrees, to be pasted into a
// scene. Reading it back gives the same bits. `size` is that of its picture: the scene's must have the same
// aspect ratio if the principal point is off the middle, or pixels are not square.
std::string camera_json(const Camera& camera, const std::string& name, uvec2 size);

}  // namespace candela
