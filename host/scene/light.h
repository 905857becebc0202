// What emits, in the units of scene.h: surfaces, the environment, and lights without a surface.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/math.h"
#include "scene/texture.h"

namespace candela {

// Radiance that a surface emits [W/(m^2 sr)], from its front side (counter-clockwise) or from both.
struct Emission {
    Textured<vec3> radiance{vec3(0)};  // Each >= 0 and finite.
    bool two_sided = false;

    bool operator==(const Emission&) const = default;
};

// Between the angles of a cone; t is linear in the cosine, 0 at the outer angle, 1 at the inner.
enum class SpotFalloff {
    square,      // t^2, as glTF's KHR_lights_punctual recommends.
    smoothstep,  // t^2 (3 - 2t), as in Cycles.
};

// The angles of a cone in which light leaves.
struct Cone {
    float inner_angle = 0.0f;       // From the axis [rad]; 0 <= inner_angle < outer_angle <= pi / 2.
    float outer_angle = PI / 4.0f;  // Beyond it, there is no light.
    SpotFalloff falloff = SpotFalloff::square;

    bool operator==(const Cone&) const = default;
};

// In which directions a surface emits.
struct Beam {
    // The full angle around the normal [rad], from MIN_SPREAD_DEGREES to pi. At half of it, the radiance has
    // fallen to 0, as linear in the tangent of the angle to the normal, as through a honeycomb; pi: it does
    // not fall.
    float spread = PI;
    std::optional<Cone> cone{};  // Of a sphere: only in that cone around Sphere::axis.

    bool operator==(const Beam&) const = default;
};
inline constexpr float MIN_SPREAD_DEGREES = 0.01f;

// Radiance from infinitely far away, as a latitude-longitude map [W/(m^2 sr)], row-major from the top. Its
// centre lies towards -Z, u grows to +X, v downwards from +Y; it is constant over each texel. A single texel
// is a constant sky.
struct Environment {
    uvec2 size{1, 1};                     // Texels.
    std::vector<vec3> radiance{vec3(0)};  // Finite, each >= 0; intensity included.
    float rotation = 0.0f;                // About +Y [rad], counter-clockwise seen from above.
    bool visible = true;                  // To camera rays; it always lights the scene and is reflected.
};

// Light from a point, equal in all directions. This light and the next two have no surface: only light
// samples find them.
struct PointLight {
    dvec3 position{0};
    vec3 intensity{1};  // [W/sr], each >= 0 and finite.
};

// Light from a point into a cone.
struct SpotLight {
    dvec3 position{0};
    dvec3 direction{0, 0, -1};  // Direction of the axis, of any length above 0.
    vec3 intensity{1};          // Up to the inner angle [W/sr], each >= 0 and finite.
    Cone cone{};
};

// Light from infinitely far away, in a single direction or from a disk there, which rays that leave the scene
// find, too, but those of the camera.
struct DirectionalLight {
    dvec3 direction{0, 0, -1};  // The direction of travel, of any length above 0.
    vec3 irradiance{1};         // On a surface perpendicular to it [W/m^2], each >= 0 and finite.
    float angle = 0.0f;         // Across the disk [rad]; 0: a single direction; below pi.
};

struct Light {
    std::string name;
    std::variant<PointLight, SpotLight, DirectionalLight> model;
};

}  // namespace candela
