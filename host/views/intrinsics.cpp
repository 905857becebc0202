// See intrinsics.h.
#include "views/intrinsics.h"

#include <algorithm>
#include <cmath>

namespace candela {

Intrinsics intrinsics_of(const Camera& camera, uvec2 size) {
    const double focal_length = 0.5 * size.y / std::tan(0.5 * double(camera.vertical_fov));
    return {.size = size,
            .focal_length = focal_length * glm::dvec2(camera.focal_ratio, 1.0),
            .principal_point = 0.5 * glm::dvec2(size) + double(size.y) * glm::dvec2(camera.principal_offset)};
}

void set_intrinsics(const Node& node, const Intrinsics& intrinsics, Camera& camera) {
    const glm::dvec2 size(intrinsics.size), focal_length = intrinsics.focal_length;
    camera.vertical_fov = float(2.0 * std::atan(0.5 * size.y / focal_length.y));
    if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < PI))
        node.fail("the vertical field of view must lie between 0 and 180 degrees; correct the focal length");
    camera.focal_ratio = float(focal_length.x / focal_length.y);
    if (!(camera.focal_ratio <= MAX_FOCAL_RATIO && camera.focal_ratio >= 1.0f / MAX_FOCAL_RATIO))
        node.fail("one focal length is more than 1000 times the other; both are in pixels");
    camera.principal_offset = vec2((intrinsics.principal_point - 0.5 * size) / size.y);
    const vec2 off = abs(camera.principal_offset);
    if (!(std::max(off.x, off.y) <= MAX_PRINCIPAL_OFFSET)) {
        node.fail(
            "the principal point is more than 1000 heights of the picture off its middle; it is in pixels, "
            "from the "
            "upper left corner");
    }
}

Rotation checked_rotation(const Node& matrix, const Rotation& axes) {
    constexpr double TOLERANCE = 1e-3;  // Matrices are often given to three or four digits.
    const auto is_off = [](double value, double expected) {
        return !(std::abs(value - expected) <= TOLERANCE);
    };
    for (const dvec3 axis : {axes.x, axes.y, axes.z}) {
        if (is_off(length(axis), 1.0)) {
            matrix.fail(
                "the matrix scales by " + number_text(length(axis), 6) +
                " along an axis of the camera, where a rotation has 1; divide its axes by their lengths");
        }
    }
    if (is_off(dot(axes.x, axes.y), 0.0) || is_off(dot(axes.y, axes.z), 0.0) ||
        is_off(dot(axes.z, axes.x), 0.0))
        matrix.fail("the camera's axes are not at right angles to each other; give a rotation without shear");
    if (dot(cross(axes.x, axes.y), axes.z) < 0.0) {
        matrix.fail(
            "the matrix mirrors the picture: its determinant is -1; turn the sign of one of the camera's "
            "axes");
    }
    const dvec3 z = normalize(axes.z), x = normalize(cross(axes.y, z));
    return {x, cross(z, x), z};
}

void set_place(dvec3 position, dvec3 forward, dvec3 up, Camera& camera) {
    camera.position = position;
    // So far away that rounding does not turn the camera.
    camera.look_at = position + std::max(1.0, length(position)) * forward;
    camera.up = vec3(up);
}

std::vector<std::vector<double>> read_matrix(const Node& node, size_t rows, size_t columns) {
    if (!node.is_array() || node.size() != rows) {
        node.fail_expected(std::to_string(rows) + " rows of " + std::to_string(columns) + " numbers");
    }
    std::vector<std::vector<double>> matrix;
    for (const Node& row : node.elements())
        matrix.push_back(row.numbers(columns));
    return matrix;
}

void check_no_distortion(const Node& distortion) {
    if (distortion.is_array()) {
        for (const Node& coefficient : distortion.elements())
            check_no_distortion(coefficient);
        return;
    }
    if (distortion.number() == 0.0) return;
    distortion.fail(
        "the coefficient " + number_text(distortion.number(), 6) + " of \"" + std::string(distortion.key()) +
        "\" bends straight lines, which candela's lenses do not; undistort images and cameras first "
        "(colmap image_undistorter, or cv2.undistort), and remove it");
}

}  // namespace candela
