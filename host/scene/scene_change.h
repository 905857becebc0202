// What of a scene is other than before.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace candela {

// There are as many materials, meshes and shapes as there were.
struct SceneChange {
    bool environment = false;  // All of it, or whether there is one.
    bool rotation = false;     // Of the environment.
    bool lights = false;       // The punctual ones.
    bool radiance = false;     // Factors and sides of emissions; neither their textures nor what emits.
    bool materials = false;
    bool images = false;             // Their texels, order or number.
    std::vector<uint32_t> moved{};   // Shapes that are meshes in another place.
    std::vector<uint32_t> shapes{};  // Shapes that differ in any other way.
    std::vector<uint32_t> meshes{};

    bool operator==(const SceneChange&) const = default;
    bool any() const { return *this != SceneChange(); }
    bool of_geometry() const { return !moved.empty() || !shapes.empty() || !meshes.empty(); }
    // Makes this one the change that both are together.
    void add(const SceneChange& later);
};

// Notes that a shape's emission, or the environment, was one and is another now, if they differ.
void note_emission(SceneChange& change, uint32_t shape, const std::optional<Emission>& before,
                   const std::optional<Emission>& now);
void note_environment(SceneChange& change, const std::optional<Environment>& before,
                      const std::optional<Environment>& now);

// In what two scenes differ; none if they have different numbers of materials, meshes or shapes. Cameras, and
// what scenes propose, are left aside; lights are never compared.
std::optional<SceneChange> difference(const Scene& before, const Scene& now);

}  // namespace candela
