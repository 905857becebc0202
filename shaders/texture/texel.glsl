// Texels: where they lie, and what their codes stand for. shared/texture.h has the layouts.
#ifndef TEXTURE_TEXEL_GLSL
#define TEXTURE_TEXEL_GLSL

#include "scene/scene_data.glsl"

// True if `traits` have `trait`, one of the bits of `group`. What no texture of the scene has leaves no code in the
// kernel, and what all have needs no branch.
bool has_trait(uint traits, const uint trait, const uint group) {
    if ((TEXTURE_TRAITS & trait) == 0u) return false;
    return (TEXTURE_TRAITS & group & ~trait) == 0u || (traits & trait) != 0u;
}

// Component i of v.
uint component(uvec4 v, uint i) {
    uvec2 pair = i < 2u ? v.xy : v.zw;
    return (i & 1u) == 0u ? pair.x : pair.y;
}

// Light of an sRGB code in [0, 1], by IEC 61966-2-1, to a relative 8e-5; 0 and 1 are exact. Powers differ between
// devices, and a table of 256 entries takes longer to read. The polynomial in 1 - x is fitted to the least relative
// error above the curve's linear part.
vec3 srgb_decode(vec3 code) {
    vec3 y = 1.0 - code;
    precise vec3 q = vec3(0.14470205);
    q = q * y - 0.4614395;
    q = q * y + 0.62930155;
    q = q * y - 0.3980805;
    q = q * y + 0.3443761;
    q = q * y - 1.5362629;
    q = q * y + 2.276557;
    precise vec3 curve = 1.0 - q * y;
    precise vec3 line = code * (1.0 / 12.92);
    return mix(line, curve, greaterThan(code, vec3(0.04045)));
}

// A half float that is neither negative nor infinite nor NaN. (unpackHalf2x16 may flush denormals.)
float half_decode(uint h) {
    if ((h & 0x7C00u) == 0u) return float(h & 0x3FFu) * (1.0 / 16777216.0);
    return uintBitsToFloat(((h & 0x7FFFu) << 13u) + 0x38000000u);
}

// The texel (x, y) of texture t: linear red, green, blue and alpha.
vec4 texel_at(TextureRecord t, uvec2 p) {
    uint tile = (p.y >> 2u) * (t.size.x + 3u >> 2u) + (p.x >> 2u);
    uvec2 within = p & 3u;
    vec4 code;
    if (has_trait(t.traits, TEXEL_R8, TEXEL_FORMATS)) {
        uint row = component(scene_texels(t.first + tile), within.y);
        precise float grey = float(row >> 8u * within.x & 255u) * (1.0 / 255.0);
        code = vec4(vec3(grey), 1.0);
    } else if (has_trait(t.traits, TEXEL_RGBA8, TEXEL_FORMATS)) {
        uint texel = component(scene_texels(t.first + 4u * tile + within.y), within.x);
        precise vec4 rgba = vec4(uvec4(texel, texel >> 8u, texel >> 16u, texel >> 24u) & 255u) * (1.0 / 255.0);
        code = rgba;
    } else {
        uvec4 two = scene_texels(t.first + 8u * tile + 2u * within.y + (within.x >> 1u));
        uvec2 texel = (within.x & 1u) == 0u ? two.xy : two.zw;
        uvec4 halves = uvec4(texel.x & 0xFFFFu, texel.x >> 16u, texel.y & 0xFFFFu, texel.y >> 16u);
        if (has_trait(t.traits, TEXEL_RGBA16F, TEXEL_FORMATS)) {
            return vec4(half_decode(halves.x), half_decode(halves.y), half_decode(halves.z), half_decode(halves.w));
        }
        precise vec4 rgba = vec4(halves) * (1.0 / 65535.0);
        code = rgba;
    }
    if (has_trait(t.traits, TEXTURE_SRGB, TEXTURE_ENCODINGS)) code.rgb = srgb_decode(code.rgb);
    return code;
}

#endif
