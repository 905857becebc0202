// See camera_control.h.
#include "view/camera_control.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "load/quote.h"

namespace candela {
namespace {

// How close an orbit may come to a pole [rad], where the picture's right is undefined.
constexpr float POLE_DISTANCE = 0.02f;

// What a camera looks at stays at least this far away [m], so that the direction remains defined.
constexpr float LEAST_DISTANCE = 1e-4f;

struct Frame {
    vec3 right, up, forward;
};

Frame frame_of(const Camera& camera) {
    const vec3 forward = normalize(camera.look_at - camera.position);
    const vec3 right = normalize(cross(forward, camera.up));
    return {right, cross(right, forward), forward};
}

// `v` turned about the unit vector `axis` by `angle` [rad], counter-clockwise seen from its tip.
// Ref: Rodrigues 1840.
vec3 rotate(vec3 v, vec3 axis, float angle) {
    const float c = std::cos(angle);
    return c * v + std::sin(angle) * cross(axis, v) + (1.0f - c) * dot(axis, v) * axis;
}

void move(Camera& camera, vec3 shift) {
    camera.position += shift;
    camera.look_at += shift;
}

// The shortest text that reads back as the same number.
template <class Number>
std::string number(Number value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string vector(vec3 v) {
    return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]";
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

}  // namespace

void orbit(Camera& camera, float azimuth, float elevation) {
    const vec3 pole = normalize(camera.up);
    const vec3 out = camera.position - camera.look_at;
    const float distance = length(out);
    const float now = std::asin(std::clamp(dot(out, pole) / distance, -1.0f, 1.0f));
    const float limit = PI / 2 - POLE_DISTANCE;
    // A camera that begins closer to a pole may stay there.
    const float lowest = std::min(now, -limit);
    const float highest = std::max(now, limit);
    const float rise = std::clamp(now + elevation, lowest, highest) - now;
    const vec3 raised = rotate(out, frame_of(camera).right, -rise);
    const vec3 turned = rotate(raised, pole, -azimuth);
    camera.position = camera.look_at + turned * (distance / length(turned));
}

void pan(Camera& camera, vec2 shift) {
    const Frame frame = frame_of(camera);
    const float height =
        2.0f * std::tan(0.5f * camera.vertical_fov) * length(camera.look_at - camera.position);
    move(camera, -height * (shift.x * frame.right + shift.y * frame.up));
}

void dolly(Camera& camera, float factor) {
    const vec3 out = camera.position - camera.look_at;
    const float distance = length(out);
    camera.position = camera.look_at + out * (std::max(factor * distance, LEAST_DISTANCE) / distance);
}

void fly(Camera& camera, vec3 shift) {
    const Frame frame = frame_of(camera);
    move(camera, shift.x * frame.right + shift.y * frame.up + shift.z * frame.forward);
}

std::string camera_json(const Camera& camera, const std::string& name) {
    return "{\n  \"cameras\": {\n    " + quote(name) + ": {\n      \"position\": " + vector(camera.position) +
           ",\n      \"look_at\": " + vector(camera.look_at) + ",\n      \"up\": " + vector(camera.up) +
           ",\n      \"vertical_fov\": " + number(glm::degrees(double(camera.vertical_fov))) +
           ",\n      \"lens\": " + lens_json(camera.lens) + "\n    }\n  }\n}\n";
}

}  // namespace candela
