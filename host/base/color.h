// Colours.
#pragma once

#include <cmath>

#include "base/math.h"

namespace candela {

// Luminance of a linear Rec.709 colour.
inline float luminance(vec3 rgb) {
    return dot(rgb, vec3(0.2126f, 0.7152f, 0.0722f));
}

// Linear light, 0 to 1, from a code of sRGB from 0 to 1. Ref: IEC 61966-2-1.
inline float srgb_decode(float code) {
    return code > 0.04045f ? std::pow((code + 0.055f) / 1.055f, 2.4f) : code / 12.92f;
}

// The inverse of srgb_decode().
inline float srgb_encode(float light) {
    return light > 0.0031308f ? 1.055f * std::pow(light, 1.0f / 2.4f) - 0.055f : 12.92f * light;
}

}  // namespace candela
