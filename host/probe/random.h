// Random numbers for tests: the standard library's generator, independent of the renderer's own. The same on
// every machine, since the standard defines std::mt19937 bit for bit; but it leaves the order of operands and
// arguments open, so draw one number in each statement, or several within braces.
#pragma once

#include <cmath>
#include <random>

#include "base/math.h"

namespace candela {

class Random {
  public:
    explicit Random(uint32_t seed) : generator_(seed) {}

    uint32_t bits() { return uint32_t(generator_()); }
    // In [0, 1), a multiple of 2^-24.
    float unit() { return float(bits() >> 8) * 0x1p-24f; }
    vec2 square() {
        const float x = unit();
        return {x, unit()};
    }
    // In [-1, 1)^3.
    vec3 cube() {
        const float x = 2.0f * unit() - 1.0f;
        const float y = 2.0f * unit() - 1.0f;
        return {x, y, 2.0f * unit() - 1.0f};
    }
    // Uniform on the unit sphere.
    vec3 direction() {
        vec3 v = cube();
        while (dot(v, v) > 1.0f || dot(v, v) < 1e-4f)
            v = cube();
        return normalize(v);
    }

  private:
    std::mt19937 generator_;
};

}  // namespace candela
