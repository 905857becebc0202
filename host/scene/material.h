// What surfaces are made of, in the units of scene.h.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/math.h"
#include "scene/medium.h"
#include "scene/principled.h"
#include "scene/texture.h"

namespace candela {

// Lambert: f = reflectance / pi on both sides.
struct DiffuseMaterial {
    Textured<vec3> reflectance{vec3(0.5f)};  // Each in [0, 1].

    bool operator==(const DiffuseMaterial&) const = default;
};

// A diffuse base under a glossy lobe around the mirrored direction: modified Phong. diffuse + specular is at
// most 1 in each channel, so that it creates no energy.
struct PhongMaterial {
    Textured<vec3> diffuse{vec3(0)};   // kd.
    Textured<vec3> specular{vec3(0)};  // ks.
    Textured<float> exponent = 1.0f;   // n, in [0, MAX_PHONG_EXPONENT].

    bool operator==(const PhongMaterial&) const = default;
};
inline constexpr float MAX_PHONG_EXPONENT = 1e5f;

// An ideal mirror.
struct MirrorMaterial {
    Textured<vec3> reflectance{vec3(1)};  // Each in [0, 1], at any angle.

    bool operator==(const MirrorMaterial&) const = default;
};

// A metal with microfacets (GGX). Its reflectance rises to 1 towards grazing angles (Schlick).
struct ConductorMaterial {
    Textured<vec3> reflectance{vec3(1)};  // At normal incidence, each in [0, 1].
    Textured<float> alpha = 0.1f;         // Roughness, in [MIN_ALPHA, 1].

    bool operator==(const ConductorMaterial&) const = default;
};
inline constexpr float MIN_ALPHA = 1e-3f;

// A thin sheet that scatters light diffusely to both sides. reflectance + transmittance is at most 1 in each
// channel, so that it creates no energy.
struct DiffuseTransmissionMaterial {
    Textured<vec3> reflectance{vec3(0.5f)};    // On the side that light comes from.
    Textured<vec3> transmittance{vec3(0.5f)};  // On the other side.
    std::optional<Medium> inside{};            // Behind the surface; none: the same as in front of it.

    bool operator==(const DiffuseTransmissionMaterial&) const = default;
};

enum class Fresnel { schlick, exact };

// A smooth boundary between two transparent media: glass, water. Its front side is outside. Solids of it must
// be closed; they may lie within each other and overlap.
struct DielectricMaterial {
    float ior = 1.5f;  // Index of refraction behind the surface; above 0.
    std::optional<float>
        exterior_ior{};  // In front of it; none: that of the medium there, which is 1 outside of everything.
    Fresnel fresnel = Fresnel::schlick;
    Medium inside{};        // Behind the surface.
    uint32_t priority = 0;  // Where media overlap, the highest fills the space.

    bool operator==(const DielectricMaterial&) const = default;
};
inline constexpr uint32_t MAX_PRIORITY = 15;

// The end of a medium without a surface: light passes it straight. Solids of it must be closed.
struct InterfaceMaterial {
    Medium inside{};        // Behind it.
    uint32_t priority = 0;  // As in DielectricMaterial.

    bool operator==(const InterfaceMaterial&) const = default;
};

// Heights above a surface, for the normals that it would have if it were displaced by them.
struct BumpMap {
    Texture texture{};   // Only its channel is used.
    float scale = 1.0f;  // The height for a value of 1 [m].
    // As stated by a mesh's own file: the height for a value of 1 in units of the mesh, or, if the image
    // turns out to hold normals, the scale of the normal map.
    std::optional<float> multiplier{};

    bool operator==(const BumpMap&) const = default;
};

// Opacity: some rays pass a surface as if it were not there.
struct Opacity {
    Textured<float> value = 1.0f;   // The probability that a ray does not, in [0, 1].
    std::optional<float> cutoff{};  // If given, no ray passes where the value is at least this, and every ray
                                    // passes elsewhere.

    bool operator==(const Opacity&) const = default;
};

// Whether the camera sees a surface only by how it darkens what is behind the picture; docs/catcher.md
// defines it.
enum class Catcher {
    none,
    shadows,
    reflections,  // It also reflects the rest of the scene.
    holdout,      // Not at all: it sees what is behind the picture.
};

struct Material {
    std::string name;
    std::variant<DiffuseMaterial, PhongMaterial, MirrorMaterial, ConductorMaterial, DielectricMaterial,
                 DiffuseTransmissionMaterial, InterfaceMaterial, PrincipledMaterial>
        model;
    std::optional<NormalMap> normal_map{};
    std::optional<BumpMap> bump_map{};  // Not beside a normal map.
    Opacity opacity{};
    bool vertex_colors =
        false;  // The colours of vertices are factors of the model's first colour and of opacity.
    Catcher catcher = Catcher::none;
    bool hidden = false;  // From the camera: its rays pass. Light and reflections meet the surface.
    // The material that this one repeats, for shapes that the camera sees in another way.
    std::optional<uint32_t> original{};

    bool operator==(const Material&) const = default;
};

}  // namespace candela
