// What the kernel that denoises by variance shares with the host: layers, push constants and parameters.
#ifndef SHARED_DENOISE_H
#define SHARED_DENOISE_H

#include "shared/types.h"

#ifdef __cplusplus
namespace candela {
#endif

// Layers of the working image (rgba32f). The *irradiance* of a pixel is its colour over its albedo, in a unit that
// makes it about 1; variances are those of it, per channel. A layer of irradiance is followed by that of its variance.
const uint DENOISE_LAYER_NORMAL = 0u;   // rgb: mean normal; a: variance of that mean, all coordinates together; below 0
                                        // if the features of the pixel are unknown.
const uint DENOISE_LAYER_ALBEDO = 1u;   // rgb: albedo.
const uint DENOISE_LAYER_SAMPLED = 2u;  // rgb: variance from the samples, or DENOISE_*.
const uint DENOISE_LAYER_NOISY = 3u;    // rgb: irradiance; a: coverage.
const uint DENOISE_LAYER_VARIANCE = 4u;        // rgb: smoothed variance; a: 1.
const uint DENOISE_LAYER_FIRST = 5u;           // rgb: filtered irradiance; a: filtered coverage.
const uint DENOISE_LAYER_FIRST_VARIANCE = 6u;  // rgb: its variance; a: weight of the pixel's own noisy value.
const uint DENOISE_LAYER_SECOND = 7u;
const uint DENOISE_LAYER_SECOND_VARIANCE = 8u;
const uint DENOISE_LAYER_COUNT = 9u;
const uint DENOISE_LAYERS_GIVEN = 4u;  // The host fills the first ones.

// In place of red's variance:
const float DENOISE_UNKNOWN = -1.0;  // The pixel has a value, but its samples tell no variance.
const float DENOISE_MISSING = -2.0;  // The pixel has no value.

struct DenoisePush {
    uvec2 size;       // Pixels of the working image that hold a part of the picture, from its corner on.
    uvec2 origin;     // The first pixel to compute.
    uvec2 count;      // Pixels to compute.
    uint source;      // Layer that is filtered.
    uint guide;       // Layer whose differences decide.
    uint target;      // Layer to write.
    uint step;        // Distance of neighbours [pixels].
    float tolerance;  // Squared: differences up to this many standard deviations count little.
    float outlier;    // A neighbour's variance counts up to this multiple of the pixel's own.
};

const uint DENOISE_BINDING_IMAGE = 0u;
const uint DENOISE_CONSTANT_PASS = 0u;  // DENOISE_PASS_*
const uint DENOISE_CONSTANT_COUNT = 1u;
const uint DENOISE_PASS_VARIANCE = 0u;
const uint DENOISE_PASS_FILTER = 1u;

const int DENOISE_RADIUS = 2;  // Steps from a pixel to its furthest neighbours.

#ifdef __cplusplus
}  // namespace candela
#endif

#endif
