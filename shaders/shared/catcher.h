// Catchers: surfaces that the camera sees only by how they darken, and perhaps reflect, what is behind the picture.
// docs/catcher.md defines them.
#ifndef SHARED_CATCHER_H
#define SHARED_CATCHER_H

#include "shared/types.h"

#ifdef __cplusplus
namespace candela {
#endif

const uint CATCHER_NONE = 0u;
const uint CATCHER_SHADOWS = 1u;
const uint CATCHER_REFLECTIONS = 2u;  // It also reflects the rest of the scene.
const uint CATCHER_HOLDOUT = 3u;      // No catcher: the camera sees what is behind the picture.

#ifdef __cplusplus
}  // namespace candela
#endif

#endif
