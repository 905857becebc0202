// The tone curves and the sRGB encoding, by the formulas of host/image/tonemap.cpp, which has their references.
#ifndef BASE_TONEMAP_GLSL
#define BASE_TONEMAP_GLSL

#include "base/color.glsl"
#include "shared/display.h"

vec3 tonemap_reinhard(vec3 colour) {
    return colour / (1.0 + luminance(colour));
}

vec3 tonemap_aces(vec3 colour) {
    const mat3 input_matrix = mat3(0.59719, 0.07600, 0.02840,  //
                                   0.35458, 0.90834, 0.13383,  //
                                   0.04823, 0.01566, 0.83777);
    const mat3 output_matrix = mat3(1.60475, -0.10208, -0.00327,  //
                                    -0.53108, 1.10813, -0.07276,  //
                                    -0.07367, -0.00605, 1.07602);
    vec3 v = input_matrix * colour;
    vec3 numerator = v * (v + 0.0245786) - 0.000090537;
    vec3 denominator = v * (0.983729 * v + 0.4329510) + 0.238081;
    return output_matrix * (numerator / denominator);
}

vec3 tonemap_agx(vec3 colour) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,  //
                            0.0784335999999992, 0.878468636469772, 0.0784336,           //
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,  //
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,  //
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    const float MIN_EV = -12.47393;
    const float MAX_EV = 4.026069;
    // GLSL does not guarantee that log2(0) is -infinity.
    vec3 ev = clamp(log2(max(inset * colour, 1e-10)), MIN_EV, MAX_EV);
    vec3 x = (ev - MIN_EV) / (MAX_EV - MIN_EV);
    vec3 sigmoid = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
    return pow(max(outset * sigmoid, 0.0), vec3(2.2));
}

vec3 tonemap_neutral(vec3 colour) {
    const float F90 = 0.04;
    const float START = 0.8 - F90;
    const float DESATURATION = 0.15;
    float lowest = min(colour.x, min(colour.y, colour.z));
    float fresnel = lowest <= 2.0 * F90 ? lowest - lowest * lowest / (4.0 * F90) : F90;
    vec3 base = colour - fresnel;
    float peak = max(base.x, max(base.y, base.z));
    if (peak <= START) return base;
    float new_peak = 1.0 - (1.0 - START) * (1.0 - START) / (peak + 1.0 - 2.0 * START);
    float saturation = 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    return mix(vec3(new_peak), base * (new_peak / peak), saturation);
}

// Maps finite linear Rec.709 to the light that the display should emit, in [0, 1]; `curve` is one of TONEMAP_*.
vec3 tonemap(uint curve, vec3 colour) {
    const float LARGEST = 1e18;
    vec3 c = clamp(colour, 0.0, LARGEST);
    switch (curve) {
        case TONEMAP_REINHARD: c = tonemap_reinhard(c); break;
        case TONEMAP_ACES: c = tonemap_aces(c); break;
        case TONEMAP_AGX: c = tonemap_agx(c); break;
        case TONEMAP_NEUTRAL: c = tonemap_neutral(c); break;
        default: break;
    }
    return clamp(c, 0.0, 1.0);
}

// Display light in [0, 1] to sRGB in [0, 1].
vec3 encode_srgb(vec3 light) {
    vec3 curve = 1.055 * pow(max(light, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
    return mix(curve, 12.92 * light, lessThanEqual(light, vec3(0.0031308)));
}

#endif
