// The difference between two states of a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace candela {

// The numbers of materials and shapes are unchanged; meshes without triangles may be added.
struct SceneChange {
    bool environment = false;  // All of it, or whether there is one.
    bool rotation = false;     // Only of the environment.
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
    // Makes this the change of both, one after the other.
    void add(const SceneChange& later);
};

// Whether two meshes have the same bits.
bool is_same(const TriangleMesh& a, const TriangleMesh& b);

// Notes the differences of a shape, if there are any.
void note_shape(SceneChange& change, uint32_t shape, const Shape& before, const Shape& now);

// Notes a difference of a shape's emission, or of the environment, if there is one.
void note_emission(SceneChange& change, uint32_t shape, const std::optional<Emission>& before,
                   const std::optional<Emission>& now);
void note_environment(SceneChange& change, const std::optional<Environment>& before,
                      const std::optional<Environment>& now);

// The difference of two scenes; none if their numbers of materials, meshes or shapes differ. Cameras and the
// settings that scenes propose are ignored; punctual lights, if there are any, are always said to differ.
std::optional<SceneChange> difference(const Scene& before, const Scene& now);

}  // namespace candela
