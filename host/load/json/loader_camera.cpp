// Cameras: place and view, field of view (an angle, or film and focal length) and lens, or another
// projection.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

#include "base/text.h"
#include "load/json/loader_parts.h"
#include "scene/lens_shift.h"
#include "scene/names.h"

namespace candela {
namespace {

// Width and height of the film, whose aspect ratio must be the picture's.
glm::dvec2 read_film_size(const Node& node, const Film& film) {
    constexpr double ASPECT_TOLERANCE = 1e-3;  // Film sizes are given to about three digits.
    const std::vector<Node> sides = node.elements();
    if (sides.size() != 2) node.fail_expected("two numbers [width, height]");
    const glm::dvec2 size(sides[0].positive(), sides[1].positive());
    const double aspect = double(film.size.x) / film.size.y;
    if (std::abs(size.x / size.y / aspect - 1.0) > ASPECT_TOLERANCE) {
        node.fail("the aspect ratio of film_size must be that of the film's size, " +
                  std::to_string(film.size.x) + " by " + std::to_string(film.size.y) +
                  " pixels; pixels are square");
    }
    return size;
}

// One focal length, or two along x and y.
glm::dvec2 read_focal_length(const Node& node) {
    if (!node.is_number() && !node.is_array()) node.fail_expected("one number or two [x, y]");
    if (node.is_number()) return glm::dvec2(node.positive());
    const std::vector<Node> both = node.elements();
    if (both.size() != 2) node.fail_expected("one number or two [x, y]");
    const glm::dvec2 length(both[0].positive(), both[1].positive());
    const double ratio = length.x / length.y;
    if (!(ratio <= double(MAX_FOCAL_RATIO) && ratio >= 1.0 / double(MAX_FOCAL_RATIO)))
        node.fail("one focal length is more than 1000 times the other; both are in the unit of film_size");
    return length;
}

// The principal point off the middle of the film, in the film's heights.
vec2 read_principal_offset(const Node& node, glm::dvec2 film_size) {
    const std::vector<double> point = node.numbers(2);
    const vec2 offset((glm::dvec2(point[0], point[1]) - 0.5 * film_size) / film_size.y);
    if (!(std::max(std::abs(offset.x), std::abs(offset.y)) <= MAX_PRINCIPAL_OFFSET)) {
        node.fail(
            "the principal point is more than 1000 heights of the film off its middle; it is in the unit of "
            "film_size, from the upper left corner");
    }
    return offset;
}

vec2 read_shift(const Node& node, const Film& film) {
    const std::vector<double> shift = node.numbers(2);
    const auto offset = shifted_offset({shift[0], shift[1]}, film.size);
    if (!offset) node.fail(SHIFT_TOO_LARGE);
    return *offset;
}

// Throws Error, which ends with how to choose, for the first of these keys that the camera has.
void refuse_keys(const Node& node, std::initializer_list<const char*> keys, const std::string& kind,
                 const std::string& reason, const std::string& alternative) {
    for (const char* key : keys) {
        if (const auto other = node.find(key))
            other->fail(concat(kind, ' ', reason, "; remove \"", key, "\" or ", alternative));
    }
}

// Reads the field of view, by an angle or by film and focal length.
void read_view(const Node& node, const Film& film, Camera& camera) {
    const auto degrees = node.find("vertical_fov");
    const auto size = node.find("film_size");
    const auto focal_length = node.find("focal_length");
    const auto principal_point = node.find("principal_point");
    if (degrees ? (size || focal_length) : !(size && focal_length)) {
        node.fail(
            "a camera needs either vertical_fov, or film_size and focal_length, or orthographic_height, or "
            "projection");
    }
    if (degrees) {
        if (principal_point) {
            principal_point->fail(
                "a principal point is a place on the film; give film_size and focal_length instead of "
                "vertical_fov");
        }
        camera.vertical_fov = float(glm::radians(degrees->number()));
    } else {
        const glm::dvec2 sides = read_film_size(*size, film), length = read_focal_length(*focal_length);
        camera.vertical_fov = float(2.0 * std::atan(sides.y / (2.0 * length.y)));
        camera.focal_ratio = float(length.x / length.y);
        if (principal_point) camera.principal_offset = read_principal_offset(*principal_point, sides);
    }
    if (const auto shift = node.find("shift")) {
        if (principal_point) {
            shift->fail("a shift moves the principal point, which the camera has; remove one of the two");
        }
        camera.principal_offset = read_shift(*shift, film);
    }
    if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < PI)) {
        (degrees ? *degrees : *focal_length)
            .fail("the vertical field of view must lie between 0 and 180 degrees");
    }
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
    refuse_keys(node, {"vertical_fov", "film_size", "focal_length", "principal_point", "shift", "lens"},
                "a camera with orthographic_height", "is sharp everywhere and has no field of view",
                "orthographic_height");
    return height.positive();
}

// A camera that sees all around or far to the sides, which has none of the keys of others.
void read_panorama(const Node& node, const Node& projection, const Film& film, Camera& camera) {
    Panorama& panorama = camera.panorama.emplace();
    panorama.mapping = projection.choice(MAPPING_NAMES);
    refuse_keys(
        node, {"vertical_fov", "film_size", "focal_length", "principal_point", "orthographic_height", "lens"},
        "a camera with a projection to all sides", "is sharp everywhere and has no other field of view",
        "projection");
    if (panorama.mapping == Mapping::equirectangular) {
        refuse_keys(node, {"fisheye_fov", "shift"}, "an equirectangular camera", "sees all around",
                    "projection");
        return;
    }
    if (const auto angle = node.find("fisheye_fov")) {
        read_number(*angle, scene_key("camera", "fisheye_fov"));  // Checks it.
        panorama.fisheye_fov = float(glm::radians(angle->number()));
    }
    if (const auto shift = node.find("shift")) camera.principal_offset = read_shift(*shift, film);
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
    if (const auto projection = node.find("projection")) {
        read_panorama(node, *projection, film, camera);
        return camera;
    }
    if (const auto angle = node.find("fisheye_fov"))
        angle->fail(R"(fisheye_fov is the angle of a fisheye; add "projection": "fisheye" or "equisolid")");
    if (const auto height = node.find("orthographic_height")) {
        camera.ortho_height = read_ortho_height(node, *height);
        return camera;
    }
    read_view(node, film, camera);
    if (const auto lens = node.find("lens")) camera.lens = read_lens(*lens);
    return camera;
}

}  // namespace candela
