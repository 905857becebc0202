// The transforms of shapes in a scene file.
#pragma once

#include <vector>

#include "load/node.h"
#include "scene/scene.h"
#include "scene/transform.h"

namespace candela {

// Reads a list of steps, which apply in order, each of them one of
//     {"scale": s or [x, y, z]}, {"rotate": degrees, "axis": [x, y, z]}, {"translate": [x, y, z]},
//     {"matrix": [16 numbers, row-major]}.
// Throws Error with a place for any other content, an axis without length, a matrix that is not affine, or a
// singular result.
Transform read_transform(const Node& steps);

// Reads an array with a matrix a row, of 4 x 4 numbers or 16.
std::vector<Transform> read_transforms(const Node& node, const Scene& scene);

}  // namespace candela
