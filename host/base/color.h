// Colours.
#pragma once

#include "base/math.h"

namespace candela {

// Luminance of a linear Rec.709 colour.
inline float luminance(vec3 rgb) {
    return dot(rgb, vec3(0.2126f, 0.7152f, 0.0722f));
}

}  // namespace candela
