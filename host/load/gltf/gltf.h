// Scenes from glTF 2.0 files, .gltf and .glb. docs/gltf.md says which parts of the format are read.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "scene/load_progress.h"
#include "scene/names.h"
#include "scene/scene.h"

namespace candela {

namespace gltf {
class Contents;
class Poser;
}  // namespace gltf

// Parsed glTF files and their buffers, for further scenes of the same files, such as at another time. The
// files must not change.
struct GltfFiles {
    std::map<std::filesystem::path, std::shared_ptr<gltf::Contents>> contents{};  // By path.
    std::shared_ptr<gltf::Poser> poser{};  // Of the last scene read for its frames.
};

// The units of a file's lights.
enum class LightUnits {
    spec,     // Candela and lux; a candela is read as 1 W/sr.
    blender,  // As Blender writes them: watts times 683 lm/W.
    raw,      // Watts; for point and spot lights, the power in all directions.
};
inline constexpr Choices<LightUnits, 3> LIGHT_UNITS_NAMES{
    {{"spec", LightUnits::spec}, {"blender", LightUnits::blender}, {"raw", LightUnits::raw}}};

// The parts of a file to read. An index may be given in place of a name.
struct GltfOptions {
    std::optional<std::string> scene{};       // None: the file's default.
    std::optional<std::string> animation{};   // Or "all"; none: the first, if there is a time.
    std::optional<double> time{};             // Time of the animation [s]; none: not animated.
    bool frames = false;                      // Read it to be posed, by GltfFiles::poser, instead.
    std::optional<std::string> variant{};     // Variant of the materials; none: the file's own.
    std::optional<LightUnits> light_units{};  // None: the units of the program that wrote the file.

    bool operator==(const GltfOptions&) const = default;
};

// The message about these options for other files.
inline constexpr const char* GLTF_OPTIONS_ALONE =
    "--scene, --animation, --time, --frames, --variant and --light-units are for glTF files; leave them out";

// The size of the picture if the file's camera does not state one.
inline constexpr uvec2 GLTF_FILM_SIZE{1280, 720};

// Reads a scene and the buffers that it names, with progress in bytes and then in meshes; load_images() reads
// its images. A file without cameras gets one; light_scene() lights one without light. Throws Error with the
// JSON pointer of what is wrong. Scene::warnings gets what is odd but usable. `reach` allows files outside
// the file's folder.
Scene load_gltf_scene(const std::filesystem::path& path, const GltfOptions& options = {},
                      const LoadProgress& progress = no_progress, const ReachOptions& reach = {});

// The same for a file that may already be among `files`; if not, it is added.
Scene load_gltf_scene(const std::filesystem::path& path, const GltfOptions& options,
                      const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files);

// Adds what a file holds to a scene, as load_gltf_scene() does, but neither camera nor studio. The scene's
// own materials replace the file's materials of the same name. The file and all files that it names must be
// within scene.reach.
void add_gltf_scene(const std::filesystem::path& path, const GltfOptions& options, Scene& scene,
                    const LoadProgress& progress, GltfFiles& files);

// Adds a camera if there is none; the warning about it begins with `name`.
void complete_gltf_scene(const std::string& name, Scene& scene);

}  // namespace candela
