// Record of a principled material, PRINCIPLED_WORDS words of uvec4 and one more for each image that it takes
// values from. They follow the records of all materials in their array. MaterialRecord::specular.x says
// where, as a share of PRINCIPLED_PLACES: such a float is exact, and stays so in products with 1 and below a
// limit of 1.
//
//   0: metalness, roughness, diffuse_roughness, specular
//   1: specular_color.rgb, transmission
//   2: diffuse_transmission_color.rgb, diffuse_transmission
//   3: coat, coat_roughness, coat_ior, coat_darkening
//   4: sheen_color.rgb, sheen_roughness
//   5: iridescence, iridescence_ior, thickness, thickness_range
//   6: anisotropy, rotation.xy, dispersion
//   7: coat_normal, coat_normal_scale, images, coat_internal
//   8: fuzz_color.rgb, fuzz_roughness
//   9: fuzz, 0, 0, 0
#ifndef SHARED_PRINCIPLED_H
#define SHARED_PRINCIPLED_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint PRINCIPLED_WORDS = 10u;
const uint PRINCIPLED_PLACES = 0x1000000u;

// Values that images give, a bit each in PrincipledImage::values.
const uint PRINCIPLED_BASE_COLOR = 0u;  // Four colours,
const uint PRINCIPLED_SPECULAR_COLOR = 1u;
const uint PRINCIPLED_DIFFUSE_TRANSMISSION_COLOR = 2u;
const uint PRINCIPLED_SHEEN_COLOR = 3u;
const uint PRINCIPLED_ANISOTROPY_MAP = 4u;  // a direction and a number,
const uint PRINCIPLED_METALNESS = 5u;       // and numbers, each from a channel of its own.
const uint PRINCIPLED_ROUGHNESS = 6u;
const uint PRINCIPLED_DIFFUSE_ROUGHNESS = 7u;
const uint PRINCIPLED_SPECULAR = 8u;
const uint PRINCIPLED_TRANSMISSION = 9u;
const uint PRINCIPLED_DIFFUSE_TRANSMISSION = 10u;
const uint PRINCIPLED_COAT = 11u;
const uint PRINCIPLED_COAT_ROUGHNESS = 12u;
const uint PRINCIPLED_SHEEN_ROUGHNESS = 13u;
const uint PRINCIPLED_IRIDESCENCE = 14u;
const uint PRINCIPLED_IRIDESCENCE_THICKNESS = 15u;
const uint PRINCIPLED_ANISOTROPY = 16u;
const uint PRINCIPLED_FUZZ_COLOR = 17u;  // A colour
const uint PRINCIPLED_FUZZ = 18u;        // and two numbers more.
const uint PRINCIPLED_FUZZ_ROUGHNESS = 19u;
const uint PRINCIPLED_VALUES = 20u;

// Parts of the material that some principled material of a scene has, a bit each: the specialization constant
// PRINCIPLED.
const uint PRINCIPLED_HAS_METAL = 1u << 0u;
const uint PRINCIPLED_HAS_ROUGH = 1u << 1u;  // Specular lobes with roughness.
const uint PRINCIPLED_HAS_ANISOTROPY = 1u << 2u;
const uint PRINCIPLED_HAS_DIFFUSE = 1u << 3u;
const uint PRINCIPLED_HAS_DIFFUSE_ROUGHNESS = 1u << 4u;
const uint PRINCIPLED_HAS_DIFFUSE_TRANSMISSION = 1u << 5u;
const uint PRINCIPLED_HAS_THIN = 1u << 6u;      // Specular transmission through a wall,
const uint PRINCIPLED_HAS_VOLUME = 1u << 7u;    // or into a medium.
const uint PRINCIPLED_HAS_SPECULAR = 1u << 8u;  // The dielectric's reflection has a weight or a colour.
const uint PRINCIPLED_HAS_DISPERSION = 1u << 9u;
const uint PRINCIPLED_HAS_COAT = 1u << 10u;
const uint PRINCIPLED_HAS_COAT_DARKENING = 1u << 11u;
const uint PRINCIPLED_HAS_COAT_NORMAL = 1u << 12u;  // Some coat has another normal than its base.
const uint PRINCIPLED_HAS_SHEEN = 1u << 13u;
const uint PRINCIPLED_HAS_IRIDESCENCE = 1u << 14u;
const uint PRINCIPLED_HAS_IMAGES = 1u << 15u;
const uint PRINCIPLED_HAS_COATED_EMISSION = 1u << 16u;  // Some light lies under one of the layers.
const uint PRINCIPLED_HAS_CULLED = 1u << 17u;           // Rays pass some surface from behind.
const uint PRINCIPLED_HAS_FUZZ = 1u << 18u;
// Light samples count that lie behind some surface.
const uint PRINCIPLED_IS_LIT_FROM_BEHIND = 1u << 30u;

struct PrincipledRecord {
    float metalness;  // Weights and colours are in [0, 1].
    float roughness;
    float diffuse_roughness;
    float specular;
    vec3 specular_color;
    float transmission;
    vec3 diffuse_transmission_color;
    float diffuse_transmission;
    float coat;
    float coat_roughness;
    float coat_ior;
    float coat_darkening;
    vec3 sheen_color;
    float sheen_roughness;
    float iridescence;
    float iridescence_ior;
    float thickness;        // Of the film [nm] where its image is 0,
    float thickness_range;  // and what is added where it is 1 or where there is none.
    float anisotropy;
    vec2 rotation;     // Cosine and sine of the angle by which the tangent is turned.
    float dispersion;  // 20 / Abbe number.
    uint coat_normal;  // Texture of the coat's normals, or TEXTURE_NONE.
    float coat_normal_scale;
    uint images;
    float coat_internal;  // Share of diffuse light that the coat reflects from below.
    vec3 fuzz_color;
    float fuzz_roughness;
    float fuzz;
};

// What comes from an image.
struct PrincipledImage {
    uint texture;
    uint values;     // Bits 1 << PRINCIPLED_*.
    uvec2 channels;  // Two bits for each value, from the lowest: the channel of a number.
};

#ifdef __cplusplus

inline std::array<uvec4, PRINCIPLED_WORDS> pack(const PrincipledRecord& p) {
    const auto four = [](float x, float y, float z, float w) { return word(vec3(x, y, z), floatBitsToUint(w)); };
    return {four(p.metalness, p.roughness, p.diffuse_roughness, p.specular),
            word(p.specular_color, floatBitsToUint(p.transmission)),
            word(p.diffuse_transmission_color, floatBitsToUint(p.diffuse_transmission)),
            four(p.coat, p.coat_roughness, p.coat_ior, p.coat_darkening),
            word(p.sheen_color, floatBitsToUint(p.sheen_roughness)),
            four(p.iridescence, p.iridescence_ior, p.thickness, p.thickness_range),
            four(p.anisotropy, p.rotation.x, p.rotation.y, p.dispersion),
            uvec4(p.coat_normal, floatBitsToUint(p.coat_normal_scale), p.images, floatBitsToUint(p.coat_internal)),
            word(p.fuzz_color, floatBitsToUint(p.fuzz_roughness)),
            four(p.fuzz, 0.0f, 0.0f, 0.0f)};
}

// What MaterialRecord::specular.x holds.
inline float principled_place(uint first) {
    return float(first) / float(PRINCIPLED_PLACES);
}

inline uvec4 pack(const PrincipledImage& i) {
    return {i.texture, i.values, i.channels.x, i.channels.y};
}

}  // namespace candela
#else

PrincipledRecord principled_unpack(uvec4 words[PRINCIPLED_WORDS]) {
    PrincipledRecord p;
    vec4 w = uintBitsToFloat(words[0]);
    p.metalness = w.x;
    p.roughness = w.y;
    p.diffuse_roughness = w.z;
    p.specular = w.w;
    w = uintBitsToFloat(words[1]);
    p.specular_color = w.xyz;
    p.transmission = w.w;
    w = uintBitsToFloat(words[2]);
    p.diffuse_transmission_color = w.xyz;
    p.diffuse_transmission = w.w;
    w = uintBitsToFloat(words[3]);
    p.coat = w.x;
    p.coat_roughness = w.y;
    p.coat_ior = w.z;
    p.coat_darkening = w.w;
    w = uintBitsToFloat(words[4]);
    p.sheen_color = w.xyz;
    p.sheen_roughness = w.w;
    w = uintBitsToFloat(words[5]);
    p.iridescence = w.x;
    p.iridescence_ior = w.y;
    p.thickness = w.z;
    p.thickness_range = w.w;
    w = uintBitsToFloat(words[6]);
    p.anisotropy = w.x;
    p.rotation = w.yz;
    p.dispersion = w.w;
    p.coat_normal = words[7].x;
    p.coat_normal_scale = uintBitsToFloat(words[7].y);
    p.images = words[7].z;
    p.coat_internal = uintBitsToFloat(words[7].w);
    w = uintBitsToFloat(words[8]);
    p.fuzz_color = w.xyz;
    p.fuzz_roughness = w.w;
    p.fuzz = uintBitsToFloat(words[9].x);
    return p;
}

// The first word of the record at that place.
uint principled_first(float place) {
    return uint(place * float(PRINCIPLED_PLACES));
}

PrincipledImage principled_image_unpack(uvec4 a) {
    return PrincipledImage(a.x, a.y, a.zw);
}

#endif

#endif
