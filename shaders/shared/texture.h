// Records of a texture (3 words of uvec4), of a material's textures (2 words), and of the textures of a light
// (1 word); and the layouts of texels and of vertex attributes.
//
//   Texture                     MaterialTextures                    LightTextures
//     0: first, size, traits      0: base | vertex_colors << 31,      0: primitive, emission, material
//     1: row_u.xyz                   specular | culled << 31, parameter,
//     2: row_v.xyz                   normal | bump << 31
//                                    catcher & 1 in bit 31 of parameter
//                                 1: opacity_texture, opacity,
//                                    cutoff, normal_scale;
//                                    catcher >> 1 in bit 31 of opacity_texture, hidden in the sign of opacity
//
// Texels lie in tiles of 4 x 4, row by row from the top; so do the texels of a tile. Tiles at the right and
// lower edges are whole.
//
//   TEXEL_R8       1 word of uvec4 per tile, a byte per texel: grey
//   TEXEL_RGBA8    4 words per tile, one component per texel, red lowest
//   TEXEL_RGBA16   8 words per tile, two components per texel, red lowest
//   TEXEL_RGBA16F  the same, half floats
#ifndef SHARED_TEXTURE_H
#define SHARED_TEXTURE_H

#include "shared/catcher.h"
#include "shared/primitive.h"

#ifdef __cplusplus
#include <array>
namespace candela {
#endif

const uint TEXTURE_WORDS = 3u;
const uint MATERIAL_TEXTURES_WORDS = 2u;
const uint LIGHT_TEXTURES_WORDS = 1u;
const uint TEXEL_WORDS = 1u;

const uint MAX_TEXTURES = 0x7FFFFFFFu;
const uint TEXTURE_NONE = MAX_TEXTURES;  // No texture.

// Texels along a side of an image.
const uint MAX_IMAGE_SIDE = 65535u;

// Traits of a texture, a bit each; it has one trait of each group. The specialization constant TEXTURE_TRAITS
// has the traits of all textures of a scene.
const uint TEXEL_R8 = 1u << 0u;
const uint TEXEL_RGBA8 = 1u << 1u;
const uint TEXEL_RGBA16 = 1u << 2u;
const uint TEXEL_RGBA16F = 1u << 3u;
const uint TEXEL_FORMATS = TEXEL_R8 | TEXEL_RGBA8 | TEXEL_RGBA16 | TEXEL_RGBA16F;
const uint TEXTURE_LINEAR = 1u << 4u;  // Codes are proportional to light.
const uint TEXTURE_SRGB = 1u << 5u;    // Codes are sRGB.
const uint TEXTURE_ENCODINGS = TEXTURE_LINEAR | TEXTURE_SRGB;
const uint TEXTURE_NEAREST = 1u << 6u;
const uint TEXTURE_BILINEAR = 1u << 7u;
const uint TEXTURE_FILTERS = TEXTURE_NEAREST | TEXTURE_BILINEAR;
const uint TEXTURE_REPEAT = 1u << 8u;  // Along u; along v, TEXTURE_WRAP_V bits further left.
const uint TEXTURE_MIRROR = 1u << 9u;
const uint TEXTURE_CLAMP = 1u << 10u;
const uint TEXTURE_WRAPS = TEXTURE_REPEAT | TEXTURE_MIRROR | TEXTURE_CLAMP;
const uint TEXTURE_WRAP_V = 3u;
const uint TEXTURE_UV0 = 1u << 14u;
const uint TEXTURE_UV1 = 1u << 15u;
const uint TEXTURE_UV_SETS = TEXTURE_UV0 | TEXTURE_UV1;
const uint TEXTURE_CHANNEL_SHIFT = 16u;  // Position of the channel for single numbers (2 bits), which is not
                                         // a trait.

struct TextureRecord {
    uint first;   // Word of its first tile.
    uvec2 size;   // Texels, at most MAX_IMAGE_SIDE.
    uint traits;  // One bit of each group, and the channel.
    vec3 row_u;   // The place along x is dot(row_u, (u, v, 1)): 0 at the left edge, with a period of 1.
    vec3 row_v;   // The place along y is dot(row_v, (u, v, 1)): 0 at the top edge, with a period of 1.
};

// The textures of a material: indices, or TEXTURE_NONE.
struct MaterialTextures {
    uint base;  // Factors of the record's fields of these names.
    uint specular;
    uint parameter;
    uint normal;           // Tangent space: x along the tangent, y along the bitangent, z along the normal; in [0, 1].
    uint bump;             // 1: the channel of `normal` is a height instead.
    float normal_scale;    // Factor of its x and y, or the height for 1, in the frame of the scene.
    uint opacity_texture;  // Its channel is a factor of `opacity`.
    float opacity;         // Probability that a ray does not pass the surface as if it were not there.
    float cutoff;          // If it is not negative, no ray passes where opacity is at least this, and every ray
                           // elsewhere.
    uint vertex_colors;    // 1: `base` and opacity are multiplied by the colours of vertices.
    uint culled;           // 1: rays pass the surface from behind.
    uint catcher;          // CATCHER_*
    uint hidden;           // 1: camera rays pass the surface.
};

// The surface of a light, and the factors of its radiance.
struct LightTextures {
    uint primitive;  // Position in leaf order.
    uint emission;   // Index of a texture, or TEXTURE_NONE.
    uint material;   // Its opacity.
};

// Values of materials or lights that come from textures, a bit each: the specialization constant TEXTURED.
const uint TEXTURED_BASE = 1u << 0u;
const uint TEXTURED_SPECULAR = 1u << 1u;
const uint TEXTURED_PARAMETER = 1u << 2u;
const uint TEXTURED_VERTEX_COLORS = 1u << 3u;
const uint TEXTURED_NORMAL = 1u << 4u;
const uint TEXTURED_OPACITY = 1u << 5u;  // Also if opacity is less than 1 everywhere.
const uint TEXTURED_EMISSION = 1u << 6u;
const uint TEXTURED_BUMP = 1u << 7u;
const uint TEXTURED_PASSABLE = 1u << 8u;  // Rays pass some surface: it has an opacity, is culled, or hidden.
const uint TEXTURED_HIDDEN = 1u << 9u;    // Some surface is hidden from the camera.
const uint TEXTURED_MATERIALS = TEXTURED_BASE | TEXTURED_SPECULAR | TEXTURED_PARAMETER | TEXTURED_VERTEX_COLORS;

// Attributes of the corners a, b, c, d of primitives, a bit each: the specialization constant ATTRIBUTES. A
// primitive has the words of each attribute that is present, in this order.
const uint ATTRIBUTE_UV0 = 1u << 0u;      // 2 words: u, v of a and b; of c and d.
const uint ATTRIBUTE_UV1 = 1u << 1u;      // 2 words.
const uint ATTRIBUTE_COLOR = 1u << 2u;    // 2 words: red, green, blue, alpha of a and b; of c and d; half floats.
const uint ATTRIBUTE_TANGENT = 1u << 3u;  // 1 word: at a, b, c, d, packed by pack_tangent().
const uint ATTRIBUTES_ALL = 15u;

// In a tangent, otherwise octahedral: the bitangent is -cross(normal, tangent).
const uint TANGENT_MIRRORED = 0x10000u;

#ifdef __cplusplus

inline std::array<uvec4, TEXTURE_WORDS> pack(const TextureRecord& t) {
    return {uvec4(t.first, t.size.x | t.size.y << 16u, t.traits, 0u), word(t.row_u, 0u), word(t.row_v, 0u)};
}

inline std::array<uvec4, MATERIAL_TEXTURES_WORDS> pack(const MaterialTextures& t) {
    return {uvec4(t.base | t.vertex_colors << 31u, t.specular | t.culled << 31u, t.parameter | (t.catcher & 1u) << 31u,
                  t.normal | t.bump << 31u),
            uvec4(t.opacity_texture | t.catcher >> 1u << 31u, floatBitsToUint(t.opacity) | t.hidden << 31u,
                  floatBitsToUint(t.cutoff), floatBitsToUint(t.normal_scale))};
}

inline std::array<uvec4, LIGHT_TEXTURES_WORDS> pack(const LightTextures& t) {
    return {uvec4(t.primitive, t.emission, t.material, 0u)};
}

// A tangent (x, y, z of unit length; w: -1 if the bitangent is mirrored) in 32 bits.
inline uint pack_tangent(vec4 t) {
    const uint direction = pack_octahedral(vec3(t.x, t.y, t.z)) & ~TANGENT_MIRRORED;
    return direction | (t.w < 0.0f ? TANGENT_MIRRORED : 0u);
}

// Words of a primitive in the array of attributes.
inline uint attribute_words(uint attributes) {
    return 2u * ((attributes & ATTRIBUTE_UV0) != 0u) + 2u * ((attributes & ATTRIBUTE_UV1) != 0u) +
           2u * ((attributes & ATTRIBUTE_COLOR) != 0u) + ((attributes & ATTRIBUTE_TANGENT) != 0u);
}

}  // namespace candela
#else

TextureRecord texture_unpack(uvec4 a, uvec4 b, uvec4 c) {
    TextureRecord t;
    t.first = a.x;
    t.size = uvec2(a.y & 0xFFFFu, a.y >> 16u);
    t.traits = a.z;
    t.row_u = uintBitsToFloat(b.xyz);
    t.row_v = uintBitsToFloat(c.xyz);
    return t;
}

// `catchers`, `hidden`: whether some material may be a catcher, or hidden.
MaterialTextures material_textures_unpack(uvec4 a, uvec4 b, bool catchers, bool hidden) {
    MaterialTextures t;
    t.base = a.x & MAX_TEXTURES;
    t.vertex_colors = a.x >> 31u;
    t.specular = a.y & MAX_TEXTURES;
    t.culled = a.y >> 31u;
    t.parameter = catchers ? a.z & MAX_TEXTURES : a.z;
    t.normal = a.w & MAX_TEXTURES;
    t.bump = a.w >> 31u;
    t.opacity_texture = catchers ? b.x & MAX_TEXTURES : b.x;
    t.catcher = catchers ? a.z >> 31u | b.x >> 31u << 1u : CATCHER_NONE;
    t.hidden = hidden ? b.y >> 31u : 0u;
    t.opacity = uintBitsToFloat(hidden ? b.y & 0x7FFFFFFFu : b.y);
    t.cutoff = uintBitsToFloat(b.z);
    t.normal_scale = uintBitsToFloat(b.w);
    return t;
}

LightTextures light_textures_unpack(uvec4 a) {
    return LightTextures(a.x, a.y, a.z);
}

#endif

#endif
