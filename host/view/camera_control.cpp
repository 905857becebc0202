// See camera_control.h.
#include "view/camera_control.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "load/quote.h"
#include "scene/camera_axes.h"
#include "scene/names.h"

namespace candela {
namespace {

// How close an orbit may come to a pole [rad], where the picture's right is undefined.
constexpr double POLE_DISTANCE = 0.02;

// The point that a camera looks at stays at least this fraction of the coordinates away, so that the
// direction remains defined.
constexpr double MIN_DISTANCE = 1e-9;

// `v` turned about the unit vector `axis` by `angle` [rad], counter-clockwise seen from its tip.
// Ref: Rodrigues 1840.
dvec3 rotate(dvec3 v, dvec3 axis, double angle) {
    const double c = std::cos(angle);
    return c * v + std::sin(angle) * cross(axis, v) + (1.0 - c) * dot(axis, v) * axis;
}

void move(Camera& camera, dvec3 shift) {
    camera.position += shift;
    camera.look_at += shift;
}

// The shortest text that reads back as the same number.
template <class Number>
std::string number(Number value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

template <class Vec>
std::string vector(Vec v) {
    return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]";
}

std::string pair(glm::dvec2 v) {
    return "[" + number(v.x) + ", " + number(v.y) + "]";
}

// How high the view is around the axis, at distance 1; of a fisheye, in a picture that is not upright.
double view_height(const Camera& camera) {
    if (!camera.panorama) return 2.0 * std::tan(0.5 * double(camera.vertical_fov));
    const double angle = double(camera.panorama->fisheye_fov);
    switch (camera.panorama->mapping) {
        case Mapping::fisheye:
            return angle;
        case Mapping::equisolid:
            return 4.0 * std::sin(0.25 * angle);
        case Mapping::equirectangular:
            break;
    }
    return double(PI);
}

std::string lens_json(const Lens& lens) {
    std::string text =
        R"({ "radius": )" + number(lens.radius) + R"(, "focal_distance": )" + number(lens.focal_distance);
    if (lens.blades > 0) {
        text += R"(, "blades": )" + std::to_string(lens.blades) + R"(, "rotation": )" +
                number(glm::degrees(double(lens.rotation)));
    }
    return text + " }";
}

// The field of view by a film whose height is 1.
std::string film_json(const Camera& camera, double aspect) {
    const double focal_length = 0.5 / std::tan(0.5 * double(camera.vertical_fov));
    const glm::dvec2 middle(0.5 * aspect, 0.5);
    return ",\n      \"film_size\": " + pair(glm::dvec2(aspect, 1.0)) +
           ",\n      \"focal_length\": " + pair(focal_length * glm::dvec2(camera.focal_ratio, 1.0)) +
           ",\n      \"principal_point\": " + pair(middle + glm::dvec2(camera.principal_offset));
}

// The shift of a fisheye's circle is in the longer sides of the picture.
std::string panorama_json(const Panorama& panorama, glm::dvec2 principal_offset, double aspect) {
    std::string text = ",\n      \"projection\": " + json_string(name_of(panorama.mapping, MAPPING_NAMES));
    if (panorama.mapping == Mapping::equirectangular) return text;
    const double degrees = std::clamp(glm::degrees(double(panorama.fisheye_fov)), double(MIN_FISHEYE_DEGREES),
                                      double(MAX_FISHEYE_DEGREES));
    text += ",\n      \"fisheye_fov\": " + number(degrees);
    if (principal_offset == glm::dvec2(0.0)) return text;
    return text +
           ",\n      \"shift\": " + pair(principal_offset * glm::dvec2(-1.0, 1.0) / std::max(aspect, 1.0));
}

std::string projection_json(const Camera& camera, double aspect) {
    if (camera.panorama) return panorama_json(*camera.panorama, glm::dvec2(camera.principal_offset), aspect);
    if (camera.ortho_height) return ",\n      \"orthographic_height\": " + number(*camera.ortho_height);
    const bool is_plain = camera.principal_offset == vec2(0.0f) && camera.focal_ratio == 1.0f;
    const std::string view =
        is_plain ? ",\n      \"vertical_fov\": " + number(glm::degrees(double(camera.vertical_fov)))
                 : film_json(camera, aspect);
    return view + ",\n      \"lens\": " + lens_json(camera.lens);
}

}  // namespace

void orbit(Camera& camera, float azimuth, float elevation) {
    const dvec3 pole = normalize(dvec3(camera.up));
    const dvec3 out = camera.position - camera.look_at;
    const double distance = length(out);
    const double now = std::asin(std::clamp(dot(out, pole) / distance, -1.0, 1.0));
    const double limit = double(PI) / 2 - POLE_DISTANCE;
    // A camera that begins closer to a pole may stay there.
    const double lowest = std::min(now, -limit);
    const double highest = std::max(now, limit);
    const double rise = std::clamp(now + double(elevation), lowest, highest) - now;
    const dvec3 raised = rotate(out, axes_of(camera).right, -rise);
    const dvec3 turned = rotate(raised, pole, -double(azimuth));
    camera.position = camera.look_at + turned * (distance / length(turned));
}

void pan(Camera& camera, vec2 shift) {
    const CameraAxes frame = axes_of(camera);
    const double height =
        camera.ortho_height.value_or(view_height(camera) * length(camera.look_at - camera.position));
    const double across = double(shift.x) / double(camera.focal_ratio);
    move(camera, -height * (across * frame.right + double(shift.y) * frame.up));
}

void dolly(Camera& camera, float factor) {
    if (camera.ortho_height) {
        // Within the limits of scene files.
        camera.ortho_height = std::clamp(double(factor) * *camera.ortho_height, 2.0 * double(FLOAT_MIN),
                                         0.5 * double(FLOAT_MAX));
        return;
    }
    const dvec3 out = camera.position - camera.look_at;
    const double distance = length(out);
    const double min = MIN_DISTANCE * length(camera.look_at) + double(FLOAT_MIN);
    camera.position = camera.look_at + out * (std::max(double(factor) * distance, min) / distance);
}

void fly(Camera& camera, dvec3 shift) {
    const CameraAxes frame = axes_of(camera);
    move(camera, shift.x * frame.right + shift.y * frame.up + shift.z * frame.forward);
}

std::string camera_json(const Camera& camera, const std::string& name, uvec2 size) {
    return "{\n  \"cameras\": {\n    " + json_string(name) +
           ": {\n      \"position\": " + vector(camera.position) +
           ",\n      \"look_at\": " + vector(camera.look_at) + ",\n      \"up\": " + vector(camera.up) +
           projection_json(camera, double(size.x) / size.y) + "\n    }\n  }\n}\n";
}

}  // namespace candela
