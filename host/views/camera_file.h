// Cameras from files of two conventions, and to them: NeRF's transforms.json, and the K, R and t of OpenCV.
// docs/cameras.md describes both.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace candela {

// Reads all cameras of a file, whose keys tell which convention it has. A camera whose picture has no size in
// the file is for one of `size` pixels. Names are unique. Throws Error that begins with the place for what
// the convention forbids, and for lenses that distort.
std::vector<Camera> read_camera_file(const std::filesystem::path& path, uvec2 size);

// A camera of a picture.
struct PictureCamera {
    Camera camera;
    uvec2 size;        // Of the picture [pixels].
    std::string file;  // The picture's, relative to the folder of the file of cameras.
};

// The text of a file at that path: OpenCV's convention if its name ends with "opencv.json", otherwise NeRF's.
// Lenses are left out. Throws Error (usage) for an orthographic camera or a panorama, which neither knows.
std::string camera_file_text(const std::filesystem::path& path, std::span<const PictureCamera> pictures);

}  // namespace candela
