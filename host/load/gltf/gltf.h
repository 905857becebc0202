// Scenes from glTF 2.0 files, .gltf and .glb. docs/gltf.md says what of the format is read.
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
}

// glTF files that have been parsed, with the buffers that were read, by path: for scenes that show them
// again, such as at another time. The files are taken not to change.
using GltfFiles = std::map<std::filesystem::path, std::shared_ptr<gltf::Contents>>;

// What the numbers of a file's lights mean.
enum class LightUnits {
    spec,     // Candela and lux; a candela counts as one W/sr.
    blender,  // Those that Blender writes: watts times 683 lm/W.
    raw,      // Watts, of point and spot lights to all directions.
};
inline constexpr Choices<LightUnits, 3> LIGHT_UNITS_NAMES{
    {{"spec", LightUnits::spec}, {"blender", LightUnits::blender}, {"raw", LightUnits::raw}}};

// Whether a studio lights the scene of a file.
enum class StudioChoice {
    automatic,  // If nothing else does.
    off,
    standard,  // In any case, and in place of an environment.
};
inline constexpr Choices<StudioChoice, 3> STUDIO_NAMES{
    {{"auto", StudioChoice::automatic}, {"off", StudioChoice::off}, {"default", StudioChoice::standard}}};

// What of a file is read. Where a name is asked for, the index of the element will do.
struct GltfOptions {
    std::optional<std::string> scene{};       // None: the file's default.
    std::optional<std::string> animation{};   // Or "all"; none: the first, if there is a time.
    std::optional<double> time{};             // Of the animation [s]; none: nodes as they stand.
    std::optional<std::string> variant{};     // Of the materials; none: those of the file.
    std::optional<LightUnits> light_units{};  // None: those of the program that wrote the file.
    std::optional<StudioChoice> studio{};     // None: automatic.

    bool operator==(const GltfOptions&) const = default;
};

// What messages say of these options for another file.
inline constexpr const char* GLTF_OPTIONS_ALONE =
    "--scene, --animation, --time, --variant, --light-units and --studio are for glTF files; leave them out";

// The picture of a file whose camera says nothing of it.
inline constexpr uvec2 GLTF_FILM_SIZE{1280, 720};

// Reads a scene and the buffers that it names, with progress in bytes and then in meshes; load_images() reads
// its images. A file without cameras gets one; add_studio() lights one without light. Throws Error with the
// JSON pointer of what is wrong. What is odd but usable goes to Scene::warnings. `reach` is what the file may
// name besides what is in its folder.
Scene load_gltf_scene(const std::filesystem::path& path, const GltfOptions& options = {},
                      const LoadProgress& progress = no_progress, const ReachOptions& reach = {});

// The same for a file that may be among `files`, which it joins.
Scene load_gltf_scene(const std::filesystem::path& path, const GltfOptions& options,
                      const LoadProgress& progress, const ReachOptions& reach, GltfFiles& files);

// Adds what a file holds to a scene, as load_gltf_scene() does, but neither camera nor studio. Materials that
// the scene has already take the place of the file's of the same name. Both it and what it names must be
// within scene.reach.
void add_gltf_scene(const std::filesystem::path& path, const GltfOptions& options, Scene& scene,
                    const LoadProgress& progress, GltfFiles& files);

// Adds the camera if it is missing; `name` is what the warning that says so begins with.
void complete_gltf_scene(const std::string& name, Scene& scene);

// Lights a scene of a glTF file by a studio, once its images have been read. Surfaces that emit are enough in
// its place if what they send to the sphere around the scene is at least a tenth of what the studio does
// (Glow::radiance), if half of the scene's area is as bright, or if they are brighter than white.
// docs/gltf.md says so to users. `name` is what the warnings begin with; no choice is the automatic one.
void add_studio(Scene& scene, const std::string& name, std::optional<StudioChoice> choice);

}  // namespace candela
