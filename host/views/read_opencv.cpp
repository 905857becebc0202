// OpenCV's K, R and t: world-to-camera, x to the right, y down, z forwards.
// Ref: OpenCV, "Camera Calibration and 3D Reconstruction".
#include <unordered_set>

#include "base/limits.h"
#include "views/intrinsics.h"
#include "views/read_parts.h"

namespace candela {
namespace {

constexpr std::string_view OF_CAMERA[] = {"width", "height", "K", "distortion", "pixel_center"};

Node require_shared(const Node& camera, const Node& root, std::string_view key) {
    const auto found = find_shared(camera, root, key);
    return found ? *found : camera.require(key);
}

Intrinsics read_opencv_intrinsics(const Node& camera, const Node& root) {
    const Node matrix = require_shared(camera, root, "K");
    const auto k = read_matrix(matrix, 3, 3);
    const Node upper = matrix[0], lower = matrix[1];
    if (k[0][1] != 0.0) upper[1].fail("K has a skew, which candela's cameras do not; set it to 0");
    if (k[1][0] != 0.0 || k[2] != std::vector<double>{0, 0, 1})
        matrix.fail("K must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]; write its rows in this order");
    const auto center = find_shared(camera, root, "pixel_center");
    const double first = center ? double(center->number(0.0f, 0.5f)) : 0.0;
    if (first != 0.0 && first != 0.5)
        center->fail_expected("0 or 0.5, the coordinates of the first pixel's centre");
    return {.size = {require_shared(camera, root, "width").integer(1, MAX_PICTURE_SIZE),
                     require_shared(camera, root, "height").integer(1, MAX_PICTURE_SIZE)},
            .focal_length = {upper[0].positive(), lower[1].positive()},
            .principal_point = {k[0][2] + 0.5 - first, k[1][2] + 0.5 - first}};
}

// Three numbers, or three rows of one number.
dvec3 read_column(const Node& node) {
    if (!node.is_array() || node.size() != 3 || !node[0].is_array()) return node.vector();
    const auto rows = read_matrix(node, 3, 1);
    return {rows[0][0], rows[1][0], rows[2][0]};
}

// The rows of R are the axes of the camera; it stands at the point X with R X + t = 0.
void read_opencv_place(const Node& node, Camera& camera) {
    const Node matrix = node.require("R");
    const auto r = read_matrix(matrix, 3, 3);
    const auto row = [&](size_t i) { return dvec3(r[i][0], r[i][1], r[i][2]); };
    const Rotation axes = checked_rotation(matrix, {row(0), row(1), row(2)});
    const dvec3 t = read_column(node.require("t"));
    set_place(-(t.x * axes.x + t.y * axes.y + t.z * axes.z), axes.z, -axes.y, camera);
}

}  // namespace

std::vector<Camera> read_opencv(const Node& root) {
    root.allow_only({"cameras"}, OF_CAMERA);
    const std::vector<Node> nodes = root.require("cameras").elements();
    if (nodes.empty()) root.require("cameras").fail("there are no cameras; add one");
    std::unordered_set<std::string> names;
    std::vector<Camera> cameras;
    for (const Node& node : nodes) {
        node.allow_only({"name", "R", "t"}, OF_CAMERA);
        if (const auto distortion = find_shared(node, root, "distortion")) check_no_distortion(*distortion);
        Camera& camera = cameras.emplace_back();
        const auto name = node.find("name");
        camera.name = name ? name->string() : std::to_string(cameras.size() - 1);
        if (!names.insert(camera.name).second)
            (name ? *name : node)
                .fail("two cameras have the name " + quote(camera.name) + "; give each its own");
        const Intrinsics intrinsics = read_opencv_intrinsics(node, root);
        set_intrinsics(node, intrinsics, camera);
        camera.film_size = intrinsics.size;
        read_opencv_place(node, camera);
    }
    return cameras;
}

}  // namespace candela
