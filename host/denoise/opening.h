// Opening: what of a plane is as long as a line.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"

namespace candela {

// The opening of the plane (row-major, of `size`) by lines of 2 radius + 1 pixels, horizontal, vertical and
// diagonal: each value falls to the greatest that all pixels of one such line through it reach. Edges stay,
// and spots smaller than a line do not. What lies beyond the plane's edge is as high as any value. A value
// follows from those up to 2 radius away.
//
// Ref: Soille, Talbot, "Directional Morphological Filtering", IEEE PAMI 23(11), 2001.
std::vector<float> opened_by_lines(const std::vector<float>& plane, uvec2 size, uint32_t radius);

}  // namespace candela
