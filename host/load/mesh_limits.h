// Limits that the readers of meshes share.
#pragma once

namespace candela {

// The greatest size of a texture coordinate. Differences and products with the scale of a texture still fit
// into floats.
inline constexpr double MOST_UV = 1e30;

}  // namespace candela
