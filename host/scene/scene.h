// A scene as plain structs, in the units that the renderer uses: metres, radians, linear Rec.709 radiance.
// World space is right-handed with +Y up. Transforms are already baked into the vertices. Nothing here knows
// of GPUs.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/math.h"

namespace candela {

// A perspective camera. Right is cross(forward, up); square pixels.
struct Camera {
    std::string name;
    vec3 position{0};
    vec3 look_at{0, 0, -1};
    vec3 up{0, 1, 0};
    float vertical_fov = 0.0f;  // Full angle [rad], in (0, pi).
};

struct Film {
    uvec2 size{512, 512};  // Pixels.
};

enum class Estimator { bsdf, light, mis };
enum class SamplerKind { independent, stratified, sobol };

// What the scene file proposes; the command line overrides it.
struct IntegratorSettings {
    uint32_t spp = 64;
    std::optional<uint32_t> max_depth;  // Scattering vertices at most; none: unlimited.
    uint32_t rr_depth = 3;              // The first rr_depth bounces always survive.
    Estimator estimator = Estimator::mis;
    SamplerKind sampler = SamplerKind::sobol;
    uint32_t seed = 0;
};

// Lambert: f = reflectance / pi on both sides.
struct DiffuseMaterial {
    vec3 reflectance{0.5f};  // Each in [0, 1].
};

struct Material {
    std::string name;
    std::variant<DiffuseMaterial> model;
};

// Radiance that a surface sends out [W/(m^2 sr)], from its front side (counter-clockwise) or from both.
struct Emission {
    vec3 radiance{0};  // Each >= 0 and finite.
    bool two_sided = false;
};

// Triangles over shared vertices; `normals` is empty (flat) or has one unit shading normal per position.
struct TriangleMesh {
    std::vector<vec3> positions;
    std::vector<vec3> normals;
    std::vector<uvec3> triangles;
};

// A planar quadrilateral with counter-clockwise corners; convex.
struct Quad {
    vec3 corners[4];
};

struct Shape {
    std::variant<TriangleMesh, Quad> geometry;
    uint32_t material = 0;             // Index into Scene::materials.
    std::optional<Emission> emission;  // None: the shape does not emit.
};

struct Scene {
    std::vector<Camera> cameras;  // At least one; the first is the default.
    Film film;
    IntegratorSettings integrator;
    std::vector<Material> materials;
    std::vector<Shape> shapes;
    std::vector<std::string> warnings;  // What the loader found odd but usable, each with its place.
};

}  // namespace candela
