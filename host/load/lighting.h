// The light of a scene, as the user asks for it, whatever its file says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scene/catchers.h"
#include "scene/scene.h"
#include "scene/sky.h"
#include "scene/studio.h"

namespace candela {

struct LightingOptions {
    std::optional<StudioChoice> studio{};                // None: automatic.
    std::optional<std::filesystem::path> environment{};  // An image, in place of the scene's environment.
    std::optional<Sky> sky{};                            // The same.
    // Changes of the environment, wherever it comes from.
    std::optional<double> rotation{};   // About +Y, counter-clockwise seen from above [degrees].
    std::optional<double> intensity{};  // A factor of its radiance, at least 0.
    bool hidden = false;                // From the camera.
    CatcherOptions catchers{};          // Among them, a ground.

    bool operator==(const LightingOptions&) const = default;
};

// What the scene was read from.
enum class SceneSource {
    gltf,    // A glTF file, perhaps named by a native scene: a studio lights it if nothing else does.
    mesh,    // An OBJ or PLY file, which has a constant sky unless it emits.
    native,  // A scene file, which states its lights itself.
};

// Lights a scene whose images have been read. Surfaces of a glTF file that emit replace the studio if they
// send at least a tenth of the studio's light to the sphere around the scene (Glow::radiance), if half of the
// scene's area is as bright, or if they are brighter than white; docs/gltf.md tells users so. Warnings begin
// with `name`. Throws Error if the image cannot be used, and Error (usage) for options that do not go
// together, or that change an environment that the scene does not have.
void light_scene(Scene& scene, const std::string& name, SceneSource source, const LightingOptions& options);

}  // namespace candela
