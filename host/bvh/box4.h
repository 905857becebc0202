// Boxes in vector registers, for the builder's inner loops: g++ and clang compile each operation to an
// instruction or two for all axes at once, on any processor.
#pragma once

#include <cstdint>

#include "base/math.h"

namespace candela {

// x, y, z, and an unused fourth lane. A comparison sets all bits of an Int4's lane, or none.
using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = int32_t;

inline Float4 min4(Float4 a, Float4 b) {
    return a < b ? a : b;
}
inline Float4 max4(Float4 a, Float4 b) {
    return a > b ? a : b;
}
inline Float4 all4(float x) {
    return Float4{x, x, x, x};
}

// Like Box, but not initialised.
struct Box4 {
    Float4 lo;
    Float4 hi;

    static Box4 empty() { return {all4(INFINITE), all4(-INFINITE)}; }

    void extend(Float4 p) {
        lo = min4(lo, p);
        hi = max4(hi, p);
    }
    void extend(const Box4& box) {
        lo = min4(lo, box.lo);
        hi = max4(hi, box.hi);
    }
    Float4 extent() const { return hi - lo; }
    float longest_side() const {
        const Float4 e = extent();
        return glm::max(e[0], glm::max(e[1], e[2]));
    }

    explicit operator Box() const { return {vec3(lo[0], lo[1], lo[2]), vec3(hi[0], hi[1], hi[2])}; }
};

}  // namespace candela
