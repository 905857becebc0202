// Lets C++ and GLSL read the same file: vector types under their GLSL names, and the reinterpretation of
// floats as the words of a record.
#ifndef SHARED_TYPES_H
#define SHARED_TYPES_H

#ifdef __cplusplus
#include <bit>

#include "base/math.h"

namespace candela {
using uint = uint32_t;
inline uint floatBitsToUint(float x) {
    return std::bit_cast<uint>(x);
}
inline float uintBitsToFloat(uint x) {
    return std::bit_cast<float>(x);
}
inline uvec4 word(vec3 xyz, uint w) {
    return uvec4(floatBitsToUint(xyz.x), floatBitsToUint(xyz.y), floatBitsToUint(xyz.z), w);
}
}  // namespace candela
#endif

#endif
