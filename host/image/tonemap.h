// From scene-linear radiance to 8-bit sRGB: exposure, tone curve, transfer function, rounding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "image/image.h"

namespace candela {

enum class Tonemap {
    linear,    // Clamps to [0, 1]; nothing else.
    reinhard,  // Compresses the luminance L to L / (1 + L).
    aces,      // Hill's fit of ACES' reference rendering and output transforms.
    agx,       // The base look of AgX.
    neutral,   // Khronos PBR Neutral: base colours stay true, highlights fade to white.
};

// Exposures lie in [-MAX_EXPOSURE_EV, MAX_EXPOSURE_EV], so that 2^EV is an ordinary float.
inline constexpr float MAX_EXPOSURE_EV = 100.0f;

// Applies a tone curve to a linear Rec.709 colour, where 1 is the white of the display without a curve.
// Returns the light that the display should emit, linear Rec.709 in [0, 1]. Any input is valid: a colour with
// a NaN becomes black, else one with a +infinity white; negative components become 0.
vec3 tonemap(Tonemap curve, vec3 colour);

// Encodes display light, linear Rec.709 in [0, 1], as sRGB and rounds to the nearest of the 256 codes; no
// dithering. Ref: IEC 61966-2-1:1999, section 5.2 (piecewise transfer function).
std::array<uint8_t, 3> encode_srgb8(vec3 light);

}  // namespace candela
