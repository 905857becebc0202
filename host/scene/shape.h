// Shapes, in the units of scene.h.
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "base/math.h"
#include "scene/light.h"
#include "scene/transform.h"

namespace candela {

// Triangles over shared vertices, counter-clockwise seen from the front, in a space of their own. The array
// of an attribute is empty or has one element per position.
struct TriangleMesh {
    glm::dvec3 origin{0};            // Origin of the positions; see set_positions() in mesh.h.
    std::vector<vec3> positions{};   // Relative to the origin.
    std::vector<vec3> normals{};     // For shading; of any length, zero if there is none. Empty: flat.
    std::vector<vec4> tangents{};    // x, y, z: the direction in which u grows; w: -1 if the bitangent is
                                     // mirrored, otherwise 1.
    std::vector<vec2> uv0{};         // First set of texture coordinates, v upwards.
    std::vector<vec2> uv1{};         // Second set.
    std::vector<vec4> colors{};      // Linear RGB, and opacity.
    std::vector<uvec3> triangles{};  // Indices of vertices.
    // For each triangle, which of several objects it belongs to, counted from that of the shape. Empty: 0.
    // Only of meshes that are shown once.
    std::vector<uint32_t> groups{};
};

// A mesh of the scene, placed in the world.
struct MeshInstance {
    uint32_t mesh = 0;      // Index into Scene::meshes.
    Transform transform{};  // From the mesh's space to the world's.

    bool operator==(const MeshInstance&) const = default;
};

// A planar, convex quadrilateral with counter-clockwise corners.
struct Quad {
    dvec3 corners[4];
    vec2 uvs[4]{{0, 0}, {1, 0}, {1, 1}, {0, 1}};  // Texture coordinates.

    bool operator==(const Quad&) const = default;
};

// A true sphere; its front is outside.
struct Sphere {
    dvec3 center{0};
    double radius = 1.0;   // Above 0.
    dvec3 axis{0, 0, -1};  // Of the cone in which it emits, if it does; of any length above 0.

    bool operator==(const Sphere&) const = default;
};

// center + x e1 + y e2 with x^2 + y^2 <= 1: a disk, or an ellipse. Its front is the side that cross(e1, e2)
// points to.
struct Disk {
    dvec3 center{0};
    dvec3 e1{1, 0, 0};
    dvec3 e2{0, 1, 0};
    vec2 uvs[3]{{0.5f, 0.5f},
                {1.0f, 0.5f},
                {0.5f, 1.0f}};  // Texture coordinates of the centre, and of the ends of e1, e2.

    bool operator==(const Disk&) const = default;
};

// No object: see Shape::object.
inline constexpr uint32_t NO_OBJECT = UINT32_MAX;

using Geometry = std::variant<MeshInstance, Quad, Sphere, Disk>;

// What a shape is in the space of its object, and where the object is.
struct Origin {
    Geometry geometry;
    Transform transform;
};

struct Shape {
    Geometry geometry;
    uint32_t material = 0;                   // Index into Scene::materials.
    std::optional<Emission> emission;        // None: the shape does not emit.
    bool states_emission = false;            // If false, the emission is its material's, and changes with it.
    uint32_t object = NO_OBJECT;             // Index into Scene::objects; NO_OBJECT: it is one by itself.
    uint32_t copy = 0;                       // The number of this instance among those of the object, from 0.
    std::shared_ptr<const Origin> origin{};  // None: a mesh that the object's transform alone places, or
                                             // another geometry, of an object that no transform places.
    bool visible = true;                     // If false, the geometry is a mesh without triangles.
    Beam beam{};                             // Where its emission goes.
};

}  // namespace candela
