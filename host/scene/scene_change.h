// What of a scene is other than before.
#pragma once

#include <cstdint>
#include <vector>

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

    bool of_geometry() const { return !moved.empty() || !shapes.empty() || !meshes.empty(); }
};

}  // namespace candela
