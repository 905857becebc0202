// See views.h.
#include "views/views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "views/fit.h"

namespace candela {
namespace {

// The tangents of half the angles of the frame, along x and y.
glm::dvec2 frame_tangents(const ViewStyle& style) {
    const glm::dvec2 size(style.size);
    const double shorter = std::min(size.x, size.y);
    const double half_height = std::tan(0.5 * double(vertical_fov(style)));
    return half_height / size.y * (size - 2.0 * style.margin * shorter);
}

// "turntable_007" of 100.
std::string numbered(const char* name, uint32_t number, uint32_t count) {
    const size_t digits = std::max<size_t>(3, std::to_string(count - 1).size());
    const std::string text = std::to_string(number);
    return std::string(name) + '_' + std::string(digits - text.size(), '0') + text;
}

}  // namespace

CameraAxes axes_towards(const ViewDirection& direction) {
    const double sin_azimuth = std::sin(direction.azimuth), cos_azimuth = std::cos(direction.azimuth);
    const double sin_elevation = std::sin(direction.elevation), cos_elevation = std::cos(direction.elevation);
    const dvec3 back(sin_azimuth * cos_elevation, sin_elevation, cos_azimuth * cos_elevation);
    const dvec3 right(cos_azimuth, 0.0, -sin_azimuth);
    const dvec3 up = cross(back, right);
    const double sin_roll = std::sin(direction.roll), cos_roll = std::cos(direction.roll);
    return {cos_roll * right - sin_roll * up, cos_roll * up + sin_roll * right, -back};
}

float vertical_fov(const ViewStyle& style) {
    if (const auto* fov = std::get_if<VerticalFov>(&style.lens)) return float(fov->angle);
    const double longer = std::max(style.size.x, style.size.y);
    const double height = SENSOR_SIDE * style.size.y / longer;  // Of the sensor [mm].
    return float(2.0 * std::atan(0.5 * height / std::get<FocalLength>(style.lens).millimetres));
}

Camera Surroundings::camera(const std::string& name, const CameraAxes& axes, dvec3 place,
                            const ViewStyle& style) const {
    // It looks at the depth of the middle, or, if that is not in front of it, some way forwards.
    const double depth = std::max(-dot(place, axes.forward), ball_.radius);
    Camera camera;
    camera.name = name;
    camera.position = shown_.origin + place;
    camera.look_at = camera.position + depth * axes.forward;
    camera.up = vec3(axes.up);
    camera.vertical_fov = vertical_fov(style);
    return camera;
}

Camera Surroundings::view(const std::string& name, const ViewDirection& direction,
                          const ViewStyle& style) const {
    const CameraAxes axes = axes_towards(direction);
    return camera(name, axes, fitted_position(shown_.bodies, axes, frame_tangents(style)), style);
}

std::vector<Camera> Surroundings::turntable(uint32_t count, double elevation, const ViewStyle& style) const {
    const CameraAxes front = axes_towards({.elevation = elevation});
    const dvec3 place = fitted_position(turned_about_axis(shown_.bodies), front, frame_tangents(style));
    std::vector<Camera> cameras;
    for (uint32_t i = 0; i < count; ++i) {
        const CameraAxes axes =
            axes_towards({.azimuth = 2.0 * std::numbers::pi * i / count, .elevation = elevation});
        const dvec3 turned = dot(place, front.up) * axes.up + dot(place, front.forward) * axes.forward;
        cameras.push_back(camera(numbered("turntable", i, count), axes, turned, style));
    }
    return cameras;
}

std::vector<Camera> Surroundings::dome(uint32_t count, const ViewStyle& style) const {
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    std::vector<Camera> cameras;
    for (uint32_t i = 0; i < count; ++i) {
        const CameraAxes axes =
            axes_towards({.azimuth = golden_angle * i, .elevation = std::asin((i + 0.5) / count)});
        const dvec3 place = fitted_position({&ball_, 1}, axes, frame_tangents(style));
        cameras.push_back(camera(numbered("dome", i, count), axes, place, style));
    }
    return cameras;
}

}  // namespace candela
