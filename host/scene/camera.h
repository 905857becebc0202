// Cameras and films, in the units of scene.h.
#pragma once

#include <optional>
#include <string>

#include "base/math.h"

namespace candela {

// A thin lens. Its aperture is a disk, or a regular polygon whose corners lie on the disk's rim.
struct Lens {
    float radius = 0.0f;          // Radius of the aperture [m]; 0: a pinhole, with everything sharp.
    float focal_distance = 1.0f;  // From the lens to the plane in focus, along the view [m]; above 0.
    uint32_t blades = 0;          // Corners of the polygon, 3 .. MAX_BLADES; 0: a disk.
    float rotation = 0.0f;        // Angle of the polygon's first corner [rad], from the right towards up.

    bool operator==(const Lens&) const = default;
};
inline constexpr uint32_t MAX_BLADES = 64;

// The most by which a principal point may be off the picture's centre, and the ratio of focal lengths off 1.
inline constexpr float MAX_PRINCIPAL_OFFSET = 1000.0f;
inline constexpr float MAX_FOCAL_RATIO = 1000.0f;

// How a camera sees all around, or far to the sides.
enum class Mapping {
    equirectangular,  // Longitude to the right, over 360 degrees, and latitude upwards, over 180.
    fisheye,          // Equidistant: the distance from the centre is proportional to the angle to the axis.
    equisolid,        // A fisheye in which equal areas show equal solid angles.
};

// What such a camera shows. A fisheye sees within a circle that touches the longer sides of the picture.
struct Panorama {
    Mapping mapping = Mapping::equirectangular;
    float fisheye_fov = PI;  // Full angle across the circle [rad], within the limits below.

    bool operator==(const Panorama&) const = default;
};
inline constexpr float MIN_FISHEYE_DEGREES = 1.0f;
inline constexpr float MAX_FISHEYE_DEGREES = 360.0f;

// A camera. Right is cross(forward, up).
struct Camera {
    std::string name;
    dvec3 position{0};
    dvec3 look_at{0, 0, -1};
    vec3 up{0, 1, 0};
    float vertical_fov = 0.0f;  // Full angle [rad], in (0, pi), if the principal point is in the middle.
    // Where the axis meets the picture: from its centre to the right and downwards, in heights of the
    // picture. Each component is at most MAX_PRINCIPAL_OFFSET in size.
    vec2 principal_offset{0};
    // The focal length in widths of a pixel over that in heights of a pixel, from 1 / MAX_FOCAL_RATIO to
    // MAX_FOCAL_RATIO; 1: pixels are square.
    float focal_ratio = 1.0f;
    // Full height of the view [m], above 0. If there is one, all rays are parallel and leave the plane
    // through the position; the camera has square pixels around its axis, no field of view and no lens.
    std::optional<double> ortho_height{};
    // If there is one, the camera is no plane's projection: it has no field of view, height or lens, and
    // square pixels. An equirectangular one has its axis in the middle.
    std::optional<Panorama> panorama{};
    Lens lens;
    std::optional<uvec2> film_size{};  // Size of the picture [pixels], if the file states it for this camera.

    bool operator==(const Camera&) const = default;
};

// How the samples of a pixel are spread around its centre. A sample belongs to one pixel.
enum class FilterShape { box, tent, gaussian, blackman_harris };
struct PixelFilter {
    FilterShape shape = FilterShape::box;
    float width = 1.0f;  // Beyond half of it the filter is 0 [pixels].

    bool operator==(const PixelFilter&) const = default;
};
inline constexpr float MIN_FILTER_WIDTH = 0.01f;
inline constexpr float MAX_FILTER_WIDTH = 10.0f;

struct Film {
    uvec2 size{512, 512};  // Pixels.
    PixelFilter filter{};
};

}  // namespace candela
