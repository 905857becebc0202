// Cameras that do not come from the scene: around what it shows, or from a file of cameras; and cameras to a
// file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command_files.h"
#include "views/camera_file.h"
#include "views/views.h"

namespace candela {

struct CameraOptions {
    struct Turntable {
        uint32_t count;
        double elevation;  // [rad].
    };

    std::vector<std::pair<std::string, ViewDirection>> views;  // By name, which is the option's text.
    std::optional<Turntable> turntable;
    std::optional<uint32_t> dome;
    std::optional<decltype(ViewStyle::lens)> lens;
    std::optional<double> margin;
    std::optional<std::string> file;
    std::optional<Panorama> projection;  // In place of the cameras' own.
    std::optional<glm::dvec2> shift;     // In longer sides of the picture, to the right and upwards.
    std::optional<std::string> written;  // A name with fields: a file for each scene.

    // Declares them on `app`; this object must not move.
    void add_to(CLI::App& app);
    // How many cameras around the scene they ask for.
    size_t view_count() const { return views.size() + (turntable ? turntable->count : 0) + dome.value_or(0); }
    // Adds the file that they read. Throws Error (usage) if it is another of the command's, for --lens and
    // --margin without views, or for --projection and --shift with them.
    void check(CommandFiles& files) const;
    // The cameras that they ask for, in their order: --view, --turntable, --dome; or those of --camera-file.
    // None: the scene's own are to be used. They are for pictures of `size`, by default the scene's. The
    // scene must still have its meshes. Throws Error as read_camera_file() does.
    std::vector<Camera> cameras(const Scene& scene, std::optional<uvec2> size) const;
    // A camera with the projection and the shift that they ask for, for a picture of `size`. Throws Error
    // (usage) for one that cannot be shifted.
    Camera changed(Camera camera, uvec2 size) const;
};

// Writes a file of cameras. The pictures' files are relative to the working folder.
void write_cameras(const std::string& file, std::vector<PictureCamera> pictures);

}  // namespace candela
