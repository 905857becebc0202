// Cameras: place and view, field of view (an angle, or film and focal length) and lens, or parallel
// projection.
#include <cmath>

#include "load/json/loader_parts.h"

namespace candela {
namespace {

// The full vertical field of view [rad] of a film behind a lens of this focal length.
double angle_of_film(const Node& size_node, const Node& focal_length, const Film& film) {
    constexpr double ASPECT_TOLERANCE = 1e-3;  // Film sizes are given to about three digits.
    const std::vector<Node> sides = size_node.elements();
    if (sides.size() != 2) size_node.fail_expected("two numbers [width, height]");
    const double width = sides[0].positive();
    const double height = sides[1].positive();
    const double aspect = double(film.size.x) / film.size.y;
    if (std::abs(width / height / aspect - 1.0) > ASPECT_TOLERANCE) {
        size_node.fail("the aspect ratio of film_size must be that of the film's size, " +
                       std::to_string(film.size.x) + " by " + std::to_string(film.size.y) +
                       " pixels; pixels are square");
    }
    return 2.0 * std::atan(height / (2.0 * focal_length.positive()));
}

float read_vertical_fov(const Node& node, const Film& film) {
    const auto degrees = node.find("vertical_fov");
    const auto size = node.find("film_size");
    const auto focal_length = node.find("focal_length");
    if (degrees ? (size || focal_length) : !(size && focal_length)) {
        node.fail(
            "a camera needs either vertical_fov, or film_size and focal_length, or orthographic_height");
    }
    const float fov =
        float(degrees ? glm::radians(degrees->number()) : angle_of_film(*size, *focal_length, film));
    if (!(fov > 0.0f && fov < PI)) {
        (degrees ? *degrees : *focal_length)
            .fail("the vertical field of view must lie between 0 and 180 degrees");
    }
    return fov;
}

Lens read_lens(const Node& node) {
    node.allow_only({}, keys_of({"lens"}));
    Lens lens;
    lens.radius = float(node.require("radius").non_negative());
    const auto distance = node.find("focal_distance");
    if (distance) lens.focal_distance = float(distance->positive());
    if (lens.radius > 0.0f && !distance) {
        node.fail("a lens with a radius above 0 needs \"focal_distance\", the distance at which it is sharp");
    }
    const auto blades = node.find("blades");
    if (blades) lens.blades = read_integer(*blades, scene_key("lens", "blades"));
    if (const auto rotation = node.find("rotation")) {
        if (!blades) rotation->fail("rotation turns the polygon of an aperture; it needs \"blades\"");
        lens.rotation = float(rotation->angle());
    }
    return lens;
}

// The height of the view of a camera with parallel rays, which has none of the keys of a perspective one.
double read_ortho_height(const Node& node, const Node& height) {
    for (const char* key : {"vertical_fov", "film_size", "focal_length", "lens"}) {
        if (const auto other = node.find(key)) {
            other->fail(
                std::string("a camera with orthographic_height is sharp everywhere and has no field of "
                            "view; remove \"") +
                key + "\" or orthographic_height");
        }
    }
    return height.positive();
}

}  // namespace

Camera read_camera(const Node& node, const Film& film) {
    constexpr double PARALLEL = 1e-6;  // Sine of the least angle between view and up.
    node.allow_only({}, keys_of({"camera"}));
    Camera camera;
    camera.name = node.key();
    const Node look_at = node.require("look_at");
    camera.position = node.require("position").vector();
    camera.look_at = look_at.vector();
    if (camera.position == camera.look_at)
        look_at.fail("the camera looks at its own position; move one of the two");
    const auto up = node.find("up");
    if (up) camera.up = vec3(up->vector());
    const dvec3 view = camera.look_at - camera.position;
    const glm::dvec3 upwards(camera.up);
    if (length(cross(view, upwards)) <= PARALLEL * length(view) * length(upwards)) {
        (up ? *up : node)
            .fail("the camera's up direction is zero or parallel to its view; give another \"up\"");
    }
    if (const auto height = node.find("orthographic_height")) {
        camera.ortho_height = read_ortho_height(node, *height);
        return camera;
    }
    camera.vertical_fov = read_vertical_fov(node, film);
    if (const auto lens = node.find("lens")) camera.lens = read_lens(*lens);
    return camera;
}

}  // namespace candela
