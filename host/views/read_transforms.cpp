// NeRF's transforms.json: camera-to-world matrices with OpenGL's axes.
// Ref: Mildenhall et al. 2020, NeRF (the format of its data); Mueller et al. 2022, Instant Neural Graphics
// Primitives (focal lengths, principal points and sizes).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_set>

#include "base/limits.h"
#include "views/intrinsics.h"
#include "views/read_parts.h"

namespace candela {
namespace {

// The focal length [pixels], by the frame if it has any, along x or y: "fl_x", or "camera_angle_x".
std::optional<double> focal_length(const Node& frame, const Node& root, const std::string& axis,
                                   double side) {
    for (const Node* const object : {&frame, &root}) {
        if (const auto pixels = object->find("fl_" + axis)) return pixels->positive();
        if (const auto angle = object->find("camera_angle_" + axis)) {
            const double value = angle->number();
            if (!(value > 0.0 && value < double(PI))) angle->fail_expected("an angle between 0 and pi [rad]");
            return 0.5 * side / std::tan(0.5 * value);
        }
    }
    return std::nullopt;
}

Intrinsics read_nerf_intrinsics(const Node& frame, const Node& root, uvec2 default_size) {
    Intrinsics result{.size = default_size};
    const auto w = find_shared(frame, root, "w"), h = find_shared(frame, root, "h");
    if (w.has_value() != h.has_value())
        (w ? *w : *h).fail("w and h are the size of a picture in pixels; give both or neither");
    if (w) result.size = uvec2(w->integer(1, MAX_PICTURE_SIZE), h->integer(1, MAX_PICTURE_SIZE));
    if (!w) {
        for (const char* key : {"fl_x", "fl_y", "cx", "cy"}) {
            if (const auto pixels = find_shared(frame, root, key))
                pixels->fail('"' + std::string(key) +
                             "\" is in pixels of a picture; also give its size, w and h");
        }
    }
    const glm::dvec2 size(result.size);
    const auto along_x = focal_length(frame, root, "x", size.x),
               along_y = focal_length(frame, root, "y", size.y);
    if (!along_x) frame.fail("there is no focal length; add fl_x [pixels] or camera_angle_x [rad]");
    result.focal_length = {*along_x, along_y.value_or(*along_x)};
    const auto cx = find_shared(frame, root, "cx"), cy = find_shared(frame, root, "cy");
    result.principal_point = {cx ? cx->number() : 0.5 * size.x, cy ? cy->number() : 0.5 * size.y};
    return result;
}

// Throws Error for a lens that is not a pinhole's.
void check_lens(const Node& object) {
    for (const char* key : {"k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"}) {
        if (const auto coefficient = object.find(key)) check_no_distortion(*coefficient);
    }
    constexpr const char* REMEDY =
        "; undistort images and cameras to a pinhole's first (colmap image_undistorter)";
    if (const auto fisheye = object.find("is_fisheye"); fisheye && fisheye->boolean())
        fisheye->fail(std::string("candela has no fisheye lens") + REMEDY);
    const auto model = object.find("camera_model");
    if (!model) return;
    for (const char* known :
         {"PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "FULL_OPENCV", "PERSPECTIVE"}) {
        if (model->string() == known) return;
    }
    model->fail("candela has no lens of the camera model " + quote(model->string()) + REMEDY);
}

// Axes of a matrix are its columns: x to the right, y up, and z backwards.
void read_nerf_place(const Node& node, Camera& camera) {
    const size_t rows = node.is_array() && node.size() == 3 ? 3 : 4;
    const auto m = read_matrix(node, rows, 4);
    if (rows == 4 && m[3] != std::vector<double>{0, 0, 0, 1})
        node[3].fail(
            "the last row of a camera-to-world matrix must be 0 0 0 1; the position is the last column");
    const auto column = [&](size_t i) { return dvec3(m[0][i], m[1][i], m[2][i]); };
    const Rotation axes = checked_rotation(node, {column(0), column(1), column(2)});
    set_place(column(3), -axes.z, axes.y, camera);
}

// The names that a frame's picture gives its camera: of the file alone, and with its folders.
struct FrameNames {
    std::string short_name, long_name;
};

FrameNames names_of(const Node& frame, size_t index) {
    const auto file = frame.find("file_path");
    const std::filesystem::path path =
        file ? std::filesystem::path(file->file_name()).lexically_normal() : std::filesystem::path();
    const std::string name = path.stem().string();
    if (name.empty() || name.starts_with('.')) return {std::to_string(index), std::to_string(index)};
    std::string folders = path.parent_path().generic_string();
    std::ranges::replace(folders, '/', '_');
    return {name, folders.empty() ? name : folders + '_' + name};
}

// Names cameras by their pictures; with folders, if pictures in several folders have the same name.
void set_names(const std::vector<Node>& frames, std::vector<Camera>& cameras) {
    std::unordered_set<std::string> short_names, long_names;
    for (size_t i = 0; i < frames.size(); ++i) {
        const FrameNames names = names_of(frames[i], i);
        short_names.insert(names.short_name);
        if (!long_names.insert(names.long_name).second) {
            frames[i].fail("another frame has the same name " + quote(names.long_name) +
                           ", after its file_path; give each a file_path of its own");
        }
    }
    for (size_t i = 0; i < frames.size(); ++i) {
        const FrameNames names = names_of(frames[i], i);
        cameras[i].name = short_names.size() < frames.size() ? names.long_name : names.short_name;
    }
}

}  // namespace

std::vector<Camera> read_transforms(const Node& root, uvec2 size) {
    const std::vector<Node> frames = root.require("frames").elements();
    if (frames.empty()) root.require("frames").fail("there are no frames; add one for each camera");
    check_lens(root);
    std::vector<Camera> cameras;
    for (const Node& frame : frames) {
        check_lens(frame);
        Camera& camera = cameras.emplace_back();
        const Intrinsics intrinsics = read_nerf_intrinsics(frame, root, size);
        set_intrinsics(frame, intrinsics, camera);
        camera.film_size = intrinsics.size;
        read_nerf_place(frame.require("transform_matrix"), camera);
    }
    set_names(frames, cameras);
    return cameras;
}

}  // namespace candela
