// Catchers, which the camera sees only by how they darken what is behind the picture; and the ground of a
// scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/names.h"
#include "scene/scene.h"

namespace candela {

// Whether the camera sees shadows on such a surface, and not the surface.
bool catches(Catcher catcher);

// What `--ground` adds to a scene; `none`: an ordinary surface.
inline constexpr Choices<Catcher, 3> GROUND_NAMES{
    {{"show", Catcher::none}, {"catch", Catcher::shadows}, {"catch-reflections", Catcher::reflections}}};

// Which surfaces are catchers, apart from what the scene's file says.
struct CatcherOptions {
    std::optional<Catcher> ground{};
    std::vector<std::string> shadows{};      // Names of materials.
    std::vector<std::string> reflections{};  // The same; they also reflect.
    std::vector<std::string> holdouts{};     // The same, for holdouts.

    bool operator==(const CatcherOptions&) const = default;
};

// Adds a ground of that material just below the lowest point of the scene: a disk thirty times as large. It
// becomes Scene::ground. Does nothing for a scene without shapes.
void add_ground(Scene& scene, Material material);

// Applies the options to a scene that is lit. Throws Error (usage) for an unknown material, and Error, whose
// message begins with `name`, for a catcher that emits light.
void make_catchers(Scene& scene, const std::string& name, const CatcherOptions& options);

// The message about a catcher that emits light, after what it is.
inline constexpr const char* CATCHER_EMITS =
    "emits light, or shows its colour in any light, and cannot catch shadows; choose another surface, or "
    "take its "
    "light away";

// Whether some shape of the scene is a catcher or a holdout.
bool has_catchers(const Scene& scene);

}  // namespace candela
