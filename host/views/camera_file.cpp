// See camera_file.h.
#include "views/camera_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "scene/names.h"
#include "views/intrinsics.h"
#include "views/read_parts.h"

namespace candela {
namespace {

// The shortest text that reads back as the same number.
std::string exact(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value + 0.0).ptr};  // Without "-0".
}

// `[a, b, c]`
template <class... Numbers>
std::string row(Numbers... numbers) {
    std::string text;
    for (const double number : {double(numbers)...})
        text += (text.empty() ? "" : ", ") + exact(number);
    return '[' + text + ']';
}

std::string size_members(uvec2 size, const char* width, const char* height) {
    return json_string(width) + ": " + std::to_string(size.x) + ", " + json_string(height) + ": " +
           std::to_string(size.y);
}

// The members of transforms.json that say how a camera projects.
std::string nerf_intrinsics(const PictureCamera& picture) {
    const Intrinsics i = intrinsics_of(picture.camera, picture.size);
    return "\"camera_angle_x\": " + exact(2.0 * std::atan(0.5 * i.size.x / i.focal_length.x)) +
           ", \"fl_x\": " + exact(i.focal_length.x) + ", \"fl_y\": " + exact(i.focal_length.y) +
           ", \"cx\": " + exact(i.principal_point.x) + ", \"cy\": " + exact(i.principal_point.y) + ", " +
           size_members(i.size, "w", "h");
}

std::string nerf_frame(const PictureCamera& picture, bool with_intrinsics) {
    const auto [right, up, forward] = axes_of(picture.camera);
    const dvec3 position = picture.camera.position;
    std::string matrix;
    for (const glm::length_t i : {0, 1, 2})
        matrix += row(right[i], up[i], -forward[i], position[i]) + ", ";
    return "    { \"file_path\": " + json_string(picture.file) +
           (with_intrinsics ? ", " + nerf_intrinsics(picture) : "") + ",\n      \"transform_matrix\": [" +
           matrix + row(0, 0, 0, 1) + "] }";
}

std::string nerf_text(std::span<const PictureCamera> pictures) {
    const std::string shared = pictures.empty() ? "" : nerf_intrinsics(pictures[0]);
    const bool is_shared = std::ranges::all_of(
        pictures, [&](const PictureCamera& picture) { return nerf_intrinsics(picture) == shared; });
    std::string frames;
    for (const PictureCamera& picture : pictures)
        frames += (frames.empty() ? "" : ",\n") + nerf_frame(picture, !is_shared);
    return "{\n" + (is_shared ? "  " + shared + ",\n" : "") + "  \"frames\": [\n" + frames + "\n  ]\n}\n";
}

std::string opencv_camera(const PictureCamera& picture) {
    const Intrinsics i = intrinsics_of(picture.camera, picture.size);
    const glm::dvec2 center = i.principal_point - 0.5;
    const auto [right, up, forward] = axes_of(picture.camera);
    const auto turned = [&, p = picture.camera.position](dvec3 axis) { return -dot(axis, p); };
    return "    { \"name\": " + json_string(picture.camera.name) + ", " +
           size_members(i.size, "width", "height") + ",\n      \"K\": [" +
           row(i.focal_length.x, 0, center.x) + ", " + row(0, i.focal_length.y, center.y) + ", " +
           row(0, 0, 1) + "],\n      \"R\": [" + row(right.x, right.y, right.z) + ", " +
           row(-up.x, -up.y, -up.z) + ", " + row(forward.x, forward.y, forward.z) +
           "],\n      \"t\": " + row(turned(right), turned(-up), turned(forward)) + " }";
}

std::string opencv_text(std::span<const PictureCamera> pictures) {
    std::string cameras;
    for (const PictureCamera& picture : pictures)
        cameras += (cameras.empty() ? "" : ",\n") + opencv_camera(picture);
    return "{\n  \"pixel_center\": 0,\n  \"cameras\": [\n" + cameras + "\n  ]\n}\n";
}

}  // namespace

std::vector<Camera> read_camera_file(const std::filesystem::path& path, uvec2 size) {
    const std::string file = path.string();
    const json::Document document{file, json::parse(read_file(path), file)};
    const Node root(document, "the file", document.root);
    if (root.find("frames")) return read_transforms(root, size);
    if (root.find("cameras")) return read_opencv(root);
    root.fail(
        "a file of cameras has the key \"frames\" (NeRF's transforms.json), or \"cameras\" (K, R and t of "
        "OpenCV); add one of them");
}

std::string camera_file_text(const std::filesystem::path& path, std::span<const PictureCamera> pictures) {
    for (const PictureCamera& picture : pictures) {
        const Camera& camera = picture.camera;
        if (!camera.ortho_height && !camera.panorama) continue;
        const std::string kind =
            camera.panorama ? name_of(camera.panorama->mapping, MAPPING_NAMES) : "orthographic";
        throw Error(quoted(path) + " cannot hold the " + kind + " camera " + quote(camera.name) +
                        "; give it a field of view, or choose another camera",
                    ErrorKind::request);
    }
    const bool opencv = lower_case(path.filename().string()).ends_with("opencv.json");
    return opencv ? opencv_text(pictures) : nerf_text(pictures);
}

}  // namespace candela
