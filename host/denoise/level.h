// The level of a picture, and which of its values count.
#pragma once

#include "base/math.h"
#include "image/image.h"

namespace candela {

class PictureLevel {
  public:
    explicit PictureLevel(const RgbPlanes& rgb);

    // A power of two near the median of the pixels' greatest channels, of those that are positive; 1 if none
    // is.
    float unit() const { return unit_; }

    // False for a value that is not finite or so far beyond the rest that it cannot be light: it counts as
    // missing.
    bool holds(vec3 value) const {
        return is_finite(value) &&
               glm::all(glm::lessThanEqual(glm::abs(value / unit_), vec3(GREATEST_VALUE)));
    }

  private:
    // A sun is some 2^20 times as bright as what it lights. Squares of greater values would soon overflow.
    static constexpr float GREATEST_VALUE = 0x1p40f;

    float unit_ = 1.0f;
};

inline vec3 rgb_at(const RgbPlanes& planes, size_t i) {
    return {planes[0][i], planes[1][i], planes[2][i]};
}

}  // namespace candela
