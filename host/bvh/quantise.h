// Packs child boxes into the 8-bit grid of a node record, rounding outwards.
#pragma once

#include <span>

#include "base/math.h"
#include "shared/bvh_node.h"

namespace candela {

// The node whose decoded child boxes contain `boxes`, as tightly as its grid allows. Boxes: 0 .. BVH_WIDTH,
// valid, coordinates up to 1e37. The caller sets `children`.
BvhNode quantise(std::span<const Box> boxes);

}  // namespace candela
