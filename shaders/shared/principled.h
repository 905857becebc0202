// Record of a principled material, PRINCIPLED_WORDS words of uvec4 and one more for each image that it takes
// values from. They follow the records of all materials in their array. MaterialRecord::specular.x says
// where, as a share of PRINCIPLED_PLACES: such a float is exact, and stays so in products with 1 and below a
// limit of 1.
//
// principled_record.inc lists what the record has: both languages get its struct, pack and unpack, and what
// images do to it, from there.
#ifndef SHARED_PRINCIPLED_H
#define SHARED_PRINCIPLED_H

#include "shared/types.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint PRINCIPLED_WORDS = 10u;
const uint PRINCIPLED_PLACES = 0x1000000u;

// Values that images give and no line of principled_record.inc, a bit each in PrincipledImage::values.
const uint PRINCIPLED_BASE_COLOR = 0u;
const uint PRINCIPLED_ANISOTROPY_MAP = 1u;  // Turns `rotation`, and multiplies `anisotropy`.
const uint PRINCIPLED_THICKNESS = 2u;       // Multiplies `thickness_range`.

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
#define FLOAT(name, word, place) float name;
#define VEC2(name, word) vec2 name;
#define VEC3(name, word) vec3 name;
#define UINT(name, word, place) uint name;
#include "shared/principled_record.inc"
};

// What comes from an image.
struct PrincipledImage {
    uint texture;
    uint values;     // 1 << bit for each value.
    uvec2 channels;  // Two bits for each value, from the lowest: the channel of a number.
};

#ifdef __cplusplus

inline std::array<uvec4, PRINCIPLED_WORDS> pack(const PrincipledRecord& p) {
    std::array<uvec4, PRINCIPLED_WORDS> words{};
#define FLOAT(name, word, place) words[word].place = floatBitsToUint(p.name);
#define VEC2(name, i) words[i].x = floatBitsToUint(p.name.x), words[i].y = floatBitsToUint(p.name.y);
#define VEC3(name, i) words[i] = word(p.name, words[i].w);
#define UINT(name, word, place) words[word].place = p.name;
#include "shared/principled_record.inc"
    return words;
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
#define FLOAT(name, word, place) p.name = uintBitsToFloat(words[word].place);
#define VEC2(name, word) p.name = uintBitsToFloat(words[word].xy);
#define VEC3(name, word) p.name = uintBitsToFloat(words[word].xyz);
#define UINT(name, word, place) p.name = words[word].place;
#include "shared/principled_record.inc"
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
