// The tone curves, each a function from non-negative finite linear Rec.709 to display light, and sRGB
// encoding.
#include "image/tonemap.h"

#include <cassert>
#include <cmath>

#include "base/color.h"
#include "base/error.h"

namespace candela {
namespace {

// Ref: Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equation 3.
vec3 reinhard(vec3 colour) {
    return colour / (1.0f + luminance(colour));
}

// A rational fit of the ACES RRT and sRGB ODT between a matrix from Rec.709 to the ACES working space with
// the RRT's desaturation, and one back. glm's matrices are written column by column. Ref: Hill, "ACES.hlsl",
// in MJP's BakingLab, https://github.com/TheRealMJP/BakingLab (2016).
vec3 aces(vec3 colour) {
    const mat3 input(0.59719f, 0.07600f, 0.02840f,  //
                     0.35458f, 0.90834f, 0.13383f,  //
                     0.04823f, 0.01566f, 0.83777f);
    const mat3 output(1.60475f, -0.10208f, -0.00327f,  //
                      -0.53108f, 1.10813f, -0.07276f,  //
                      -0.07367f, -0.00605f, 1.07602f);
    const vec3 v = input * colour;
    const vec3 numerator = v * (v + 0.0245786f) - 0.000090537f;
    const vec3 denominator = v * (0.983729f * v + 0.4329510f) + 0.238081f;
    return output * (numerator / denominator);
}

// AgX: inset towards grey, sigmoid over the logarithm, outset. The result is a code value for a display of
// exponent 2.2, so it is decoded with that exponent here; the sRGB encoding of the file follows, as for the
// other curves. Ref: Sobotka, https://github.com/sobotka/AgX (2022); the polynomial for the sigmoid and the
// matrices after Wrensch, "Minimal AgX Implementation",
// https://iolite-engine.com/blog_posts/minimal_agx_implementation (2023).
vec3 agx(vec3 colour) {
    const mat3 inset(0.842479062253094f, 0.0423282422610123f, 0.0423756549057051f,  //
                     0.0784335999999992f, 0.878468636469772f, 0.0784336f,           //
                     0.0792237451477643f, 0.0791661274605434f, 0.879142973793104f);
    const mat3 outset(1.19687900512017f, -0.0528968517574562f, -0.0529716355144438f,  //
                      -0.0980208811401368f, 1.15190312990417f, -0.0980434501171241f,  //
                      -0.0990297440797205f, -0.0989611768448433f, 1.15107367264116f);
    constexpr float MIN_EV = -12.47393f;
    constexpr float MAX_EV = 4.026069f;
    const vec3 ev = glm::clamp(glm::log2(inset * colour), MIN_EV, MAX_EV);
    const vec3 x = (ev - MIN_EV) / (MAX_EV - MIN_EV);
    const vec3 sigmoid =
        (((((15.5f * x - 40.14f) * x + 31.96f) * x - 6.868f) * x + 0.4298f) * x + 0.1191f) * x - 0.00232f;
    return glm::pow(glm::max(outset * sigmoid, 0.0f), vec3(2.2f));
}

// Subtracts the Fresnel reflection of a dielectric, so that base colours are kept, and compresses and
// desaturates colours brighter than START. Ref: Khronos PBR Neutral Tone Mapper, specification,
// https://github.com/KhronosGroup/ToneMapping (2024).
vec3 neutral(vec3 colour) {
    constexpr float F90 = 0.04f;
    constexpr float START = 0.8f - F90;
    constexpr float DESATURATION = 0.15f;
    const float lowest = glm::min(colour.x, glm::min(colour.y, colour.z));
    const float fresnel = lowest <= 2.0f * F90 ? lowest - lowest * lowest / (4.0f * F90) : F90;
    const vec3 base = colour - fresnel;
    const float peak = glm::max(base.x, glm::max(base.y, base.z));
    if (peak <= START) return base;
    const float new_peak = 1.0f - (1.0f - START) * (1.0f - START) / (peak + 1.0f - 2.0f * START);
    const float saturation = 1.0f / (DESATURATION * (peak - new_peak) + 1.0f);
    return glm::mix(vec3(new_peak), base * (new_peak / peak), saturation);
}

vec3 apply(Tonemap curve, vec3 colour) {
    switch (curve) {
        case Tonemap::linear:
            return colour;
        case Tonemap::reinhard:
            return reinhard(colour);
        case Tonemap::aces:
            return aces(colour);
        case Tonemap::agx:
            return agx(colour);
        case Tonemap::neutral:
            return neutral(colour);
    }
    assert(false);
    return colour;
}

}  // namespace

vec3 tonemap(Tonemap curve, vec3 colour) {
    // Past this every curve is at its limit; a larger number would only overflow when squared.
    constexpr float LARGEST = 1e18f;
    if (glm::any(glm::isnan(colour))) return vec3(0.0f);
    if (glm::any(glm::equal(colour, vec3(INFINITE)))) return vec3(1.0f);
    return glm::clamp(apply(curve, glm::clamp(colour, 0.0f, LARGEST)), 0.0f, 1.0f);
}

std::array<uint8_t, 3> encode_srgb8(vec3 light) {
    std::array<uint8_t, 3> codes;
    for (int i = 0; i < 3; ++i) {
        const float x = light[i];
        assert(x >= 0.0f && x <= 1.0f);
        const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
        codes[size_t(i)] = uint8_t(std::lround(encoded * 255.0f));
    }
    return codes;
}

}  // namespace candela
