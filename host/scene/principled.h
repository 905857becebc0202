// The principled material of a scene.
#pragma once

#include <cstdint>
#include <optional>

#include "base/math.h"
#include "scene/medium.h"
#include "scene/texture.h"

namespace candela {

// A normal for shading at every point: in the image's red, green and blue, from -1 to 1 (0 to 1 in the file),
// along the tangent, the bitangent and the normal of the surface.
struct NormalMap {
    Texture texture{};
    float scale = 1.0f;  // Factor of red and green, within +-MAX_NORMAL_SCALE.

    bool operator==(const NormalMap&) const = default;
};
inline constexpr float MAX_NORMAL_SCALE = 1e3f;

// The kinds of values in principled_values.inc, and their types.
enum class ValueKind {
    color,
    radiance,
    weight,
    thickness,
    number,
    index,
    angle,
    flag,
    vector_map,
    normal_map
};

template <ValueKind>
struct ValueOf {
    using Type = float;
};
template <>
struct ValueOf<ValueKind::color> {
    using Type = Textured<vec3>;
};
template <>
struct ValueOf<ValueKind::radiance> {
    using Type = Textured<vec3>;
};
template <>
struct ValueOf<ValueKind::weight> {
    using Type = Textured<float>;
};
template <>
struct ValueOf<ValueKind::thickness> {
    using Type = Textured<float>;
};
template <>
struct ValueOf<ValueKind::flag> {
    using Type = bool;
};
template <>
struct ValueOf<ValueKind::vector_map> {
    using Type = std::optional<Texture>;
};
template <>
struct ValueOf<ValueKind::normal_map> {
    using Type = std::optional<NormalMap>;
};

// A dielectric or metallic base under layers, as described by glTF 2.0 with its extensions, and additions of
// OpenPBR 1.1. principled_values.inc and docs/scene-format.md describe each value. A value that is 0 by
// default switches its layer off. Angles are in radians. An `ior` of 0 reflects all light. Without a medium
// inside, the surface is a thin wall.
struct PrincipledMaterial {
#define VALUE(kind, name, initial, min, max, needs, text) ValueOf<ValueKind::kind>::Type name = initial;
#define KEY(name, member, text) member
#include "scene/principled_values.inc"
#undef VALUE
#undef KEY

    bool operator==(const PrincipledMaterial&) const = default;
};

// The range of a value, or of the factor of its image.
struct Range {
    float min;
    float max;
};

struct PrincipledRanges {
#define VALUE(kind, name, initial, min, max, needs, text) Range name{min, max};
#define KEY(name, member, text)
#include "scene/principled_values.inc"
#undef VALUE
#undef KEY
};
inline constexpr PrincipledRanges PRINCIPLED_RANGES;

}  // namespace candela
