// Cameras around what a scene shows. The world is right-handed with +Y up; azimuth 0 is the side of +Z, which
// is the front of a glTF model, and azimuth 90 degrees that of +X, which is at the right of a picture of the
// front.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "scene/camera_axes.h"
#include "views/bodies.h"

namespace candela {

// Where a camera is, seen from what it shows.
struct ViewDirection {
    double azimuth = 0.0;    // [rad], counter-clockwise seen from above.
    double elevation = 0.0;  // [rad], from -pi/2 (below) to pi/2 (above).
    double roll = 0.0;       // Turns the camera [rad], clockwise seen from behind it.

    bool operator==(const ViewDirection&) const = default;
};

// The axes of a camera there, which are defined above and below, too: its right is horizontal before the
// roll.
CameraAxes axes_towards(const ViewDirection& direction);

// The focal length behind which a sensor's longer side is SENSOR_SIDE, the long side of full-frame film.
struct FocalLength {
    double millimetres;

    bool operator==(const FocalLength&) const = default;
};
inline constexpr double SENSOR_SIDE = 36.0;  // [mm].

// The full vertical field of view.
struct VerticalFov {
    double angle;  // [rad], in (0, pi).

    bool operator==(const VerticalFov&) const = default;
};

// How cameras are made for pictures.
struct ViewStyle {
    uvec2 size{512, 512};  // Size of the picture [pixels].
    std::variant<FocalLength, VerticalFov> lens = FocalLength{50.0};
    // What stays free along each edge of the picture, as a share of its shorter side, in [0, 0.5).
    double margin = 0.05;
};

float vertical_fov(const ViewStyle& style);

// Makes cameras around what a scene shows, all of which is in their pictures.
class Surroundings {
  public:
    explicit Surroundings(const Scene& scene)
        : shown_(shown_bodies(scene)), ball_(ball_around(shown_.bodies)) {}

    // A camera as close as possible: what it shows touches the frame (the edges of the picture, but for the
    // margin) on two opposite sides, and is in the middle along the other axis.
    Camera view(const std::string& name, const ViewDirection& direction, const ViewStyle& style) const;

    // Cameras at `count` (at least 1) azimuths, evenly from 0 on, at one elevation. Their distance is the
    // same, the least at which the frame holds all at every azimuth, whatever the count. Their names are
    // turntable_000 and so on, with as many digits as the last one needs.
    std::vector<Camera> turntable(uint32_t count, double elevation, const ViewStyle& style) const;

    // Cameras at `count` (at least 1) directions that are spread evenly over the upper half of the sphere: at
    // equal steps of height, each turned from the last by the golden angle. Their distance is the same: the
    // frame touches the sphere around all. Their names are dome_000 and so on.
    // Ref: Vogel 1979, A better way to construct the sunflower head.
    std::vector<Camera> dome(uint32_t count, const ViewStyle& style) const;

  private:
    // A camera with these axes at that place, relative to the middle.
    Camera camera(const std::string& name, const CameraAxes& axes, dvec3 place, const ViewStyle& style) const;

    ShownBodies shown_;
    Body ball_;  // Around all of it.
};

}  // namespace candela
