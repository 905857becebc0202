// The values of texels' codes.
#ifndef TEXTURE_DECODE_GLSL
#define TEXTURE_DECODE_GLSL

#include "shared/kernel_constants.h"

// True if `traits` have `trait`, one of the bits of `group`. A trait that no texture of the scene has leaves no code in
// the kernel, and a trait that all have needs no branch.
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
// devices, and a table of 256 entries is slower. The polynomial in 1 - x is fitted to the least relative error above
// the curve's linear part.
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

#endif
