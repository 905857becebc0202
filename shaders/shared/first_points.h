// What the kernel of first points and the host agree on.
#ifndef SHARED_FIRST_POINTS_H
#define SHARED_FIRST_POINTS_H

#include "shared/constants.h"

#ifdef __cplusplus
namespace candela {
#endif

// Words of uvec4 for a pixel:
//   0: what the ray hits, as in shared/first_hits.h, the surface's place in the scene's own order, and its
//      surface coordinates x, y
//   1: the point in the frame of the scene, 0
const uint FIRST_POINT_WORDS = 2u;

const uint BINDING_FIRST_POINTS = 23u;

#ifdef __cplusplus
}  // namespace candela
#endif

#endif
