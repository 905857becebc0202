// What the kernel of first hits and the host agree on.
#ifndef SHARED_FIRST_HITS_H
#define SHARED_FIRST_HITS_H

#include "shared/constants.h"

#ifdef __cplusplus
namespace candela {
#endif

// Camera rays of a pixel: one for each invocation of a work group.
const uint FIRST_HITS = WORKGROUP_SIZE * WORKGROUP_SIZE;

// The word of a ray: 0 if it hits nothing; the surface's place in the scene's own order, plus 1; or, of an
// instance, the place of its record among the nodes, with this bit.
const uint FIRST_HIT_INSTANCE = 0x80000000u;

const uint BINDING_FIRST_HITS = 22u;

// One dispatch: pixels of the accumulation image, row-major.
struct PixelRun {
    uint first;  // The number of its first pixel.
    uint width;  // Pixels in a row of the image.
};

#ifdef __cplusplus
}  // namespace candela
#endif

#endif
